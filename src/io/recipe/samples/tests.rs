use super::columns::{CONSTANT, put};
use super::*;
use crate::base64;
use crate::math::hash;
use crate::math::vec2;
use serde_json::json;

/// As a pen moves: smooth, with a little noise in every reading, from the hand's own grid unless it
/// is `raw`.
fn draw_samples(count: usize, raw: bool) -> Vec<Sample> {
    let noise = |i: usize, column: u32| {
        hash::mix(i as u32 ^ hash::mix(column)) as f32 / u32::MAX as f32 - 0.5
    };
    let one = |i: usize| {
        let t = i as f32 / 240.0;
        let at = vec2(1500.0 + 700.0 * (1.7 * t).sin(), 900.0 + 400.0 * (2.3 * t).cos());
        let sample = Sample {
            at: at + 0.3 * vec2(noise(i, 0), noise(i, 1)),
            pressure: (0.5 + 0.3 * (0.9 * t).sin() + 0.01 * noise(i, 2)).clamp(0.0, 1.0),
            tilt: vec2(20.0 * (0.3 * t).sin(), 31.0) + 0.5 * vec2(noise(i, 3), noise(i, 4)),
            time_secs: t + 0.0004 * (noise(i, 5) + 0.5),
        };
        if raw { sample } else { sample.normalized() }
    };
    (0..count).map(one).collect()
}

fn bits(samples: &[Sample]) -> Vec<[u32; COLUMNS]> {
    samples.iter().map(|sample| numbers(sample).map(f32::to_bits)).collect()
}

fn read_value(value: &Value) -> Result<Vec<Sample>> {
    read(&JsonNode::root(Path::new("r.json"), value), 1_000_000, &mut 2_000_000)
}

#[test]
fn every_reading_comes_back_in_its_very_bits() {
    for samples in [
        draw_samples(2_000, false),
        draw_samples(2_000, true),
        draw_samples(3, true),
        Vec::new(),
        vec![draw_samples(1, false)[0]; 500],
    ] {
        assert!(bits(&unpack(&pack(&samples), 2_000).unwrap()) == bits(&samples));
        assert!(bits(&read_value(&write(&samples)).unwrap()) == bits(&samples));
    }
    // Any bits at all.
    let any =
        |i: u32| of_numbers(std::array::from_fn(|c| f32::from_bits(hash::mix(i * 6 + c as u32))));
    let any: Vec<Sample> = (0..20_000).map(any).collect();
    assert!(bits(&unpack(&pack(&any), 20_000).unwrap()) == bits(&any));
    let odd = [0.0, -0.0, f32::MIN_POSITIVE, -1e-45, 1e9, -3e38, 0.1, 16_777_217.0, f32::INFINITY];
    let odd: Vec<Sample> = odd.iter().map(|&v| of_numbers([v; COLUMNS])).collect();
    assert!(bits(&unpack(&pack(&odd), 99).unwrap()) == bits(&odd));
}

#[test]
fn no_readings_take_more_than_their_share_of_a_text() {
    // Far apart, and on the finest grid for one of them.
    let far = |i: usize| {
        let (end, fine) = (if i.is_multiple_of(2) { 1.0 } else { -1.0 }, 2.0f32.powi(-24));
        let of = |most: f32| if i == 7 { fine } else { end * most };
        let (at, tilt) = (vec2(of(1e6), of(1e6)), vec2(of(90.0), of(90.0)));
        Sample { at, pressure: of(1.0).max(0.0), tilt, time_secs: of(1e6).max(0.0) }
    };
    let far: Vec<Sample> = (0..10_000).map(far).collect();
    assert!(far.iter().all(|sample| trouble(sample).is_none()));
    let mut most = 0.0f32;
    for samples in [far, draw_samples(10_000, true), draw_samples(10_000, false)] {
        let chars = pack(&samples).len() as f32 / samples.len() as f32;
        assert!(chars <= Sample::MOST_CHARS as f32, "{chars}");
        most = most.max(chars);
    }
    assert!(most > 0.9 * Sample::MOST_CHARS as f32, "{most} at most: the limit can be lower");
    let budget = Budget::default();
    assert!(
        budget.json_bytes > budget.document_samples as u64 * Sample::MOST_CHARS,
        "what fits is read"
    );
}

#[test]
fn what_the_hand_draws_takes_few_bytes() {
    let (settled, raw) = (draw_samples(10_000, false), draw_samples(10_000, true));
    let bytes = |samples: &[Sample]| pack(samples).len() as f32 / samples.len() as f32;
    assert!(bytes(&settled) < 13.0, "{}", bytes(&settled));
    assert!(bytes(&raw) < 25.0, "{}", bytes(&raw));
}

#[test]
fn what_the_hand_settles_on_stays_there() {
    for sample in draw_samples(1_000, true) {
        let settled = sample.normalized();
        assert!(bits(&[settled]) == bits(&[settled.normalized()]));
        assert!(
            (settled.at - sample.at).abs().max_element() <= 1.0 / 512.0
                && (settled.tilt - sample.tilt).length() < 0.02
        );
        assert!(
            (settled.pressure - sample.pressure).abs() < 1e-4
                && (settled.time_secs - sample.time_secs).abs() < 1e-4
        );
    }
    let wild = Sample {
        at: vec2(f32::NAN, 1e30),
        pressure: -3.0,
        tilt: vec2(500.0, f32::NAN),
        time_secs: -1.0,
    };
    assert!(trouble(&wild).is_some() && trouble(&wild.normalized()).is_none());
}

#[test]
fn few_readings_are_rows_that_can_be_read() {
    let value = json!([[12, 9, 0.5], [30.25, 33], [50, 12, 0.25, 5, -4, 1.5]]);
    assert_eq!(write(&read_value(&value).unwrap()), value);
    assert!(
        write(&draw_samples(32, false)).is_array() && write(&draw_samples(33, false)).is_string()
    );
}

#[test]
fn rows_of_any_length_open_and_are_packed_before_they_are_values() {
    let samples = draw_samples(500, false);
    let rows: Value = samples.iter().map(row).collect();
    let text = json!({ "name": "\"samples\": [[1, 2]]", "samples": rows, "other": [{ "samples" : [[1, 2]] }] });
    for text in [text.to_string(), format!("{text:#}")] {
        let packed = with_rows_packed(text.as_bytes());
        let packed: Value = serde_json::from_slice(&packed).unwrap();
        assert!(bits(&read_value(&packed["samples"]).unwrap()) == bits(&samples));
        assert_eq!(packed["name"], text_of(&text)["name"]);
        assert_eq!(
            read_value(&packed["other"][0]["samples"]).unwrap(),
            [Sample::at(vec2(1.0, 2.0))]
        );
    }
    // However short the strokes, each list of readings is one value: together they would be six
    // million.
    let hatch = format!("{{\"samples\": [{}[0, 1]]}},", "[1.5, 2e1, 0.5, 3],".repeat(29));
    let hatches = format!("{{\"strokes\": [{}{{}}]}}", hatch.repeat(40_000));
    assert!(parse(Path::new("r.json"), hatches.as_bytes(), &Budget::default()).is_ok());
    let crowd = format!("{{\"samples\": [{}[0, 1]]}}", "[1.5, 2e1, 0.5],\n".repeat(900_000));
    let parsed = parse(Path::new("r.json"), crowd.as_bytes(), &Budget::default()).unwrap();
    assert_eq!(read_value(&parsed["samples"]).unwrap().len(), 900_001);
}

fn text_of(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn what_is_not_wholly_rows_is_left_to_the_parser() {
    let rows = "[1, 2], ".repeat(40);
    for odd in [
        "[1]",
        "[1, \"2\"]",
        "[1, 2, 3, 4, 5, 6, 7]",
        "[01, 2]",
        "[1., 2]",
        "[.5, 2]",
        "[+1, 2]",
        "[1, 2",
        "null",
        "",
    ] {
        let text = format!("{{\"samples\": [{rows}{odd}]}}");
        assert!(matches!(with_rows_packed(text.as_bytes()), Cow::Borrowed(_)), "{odd}");
    }
    for cut in ["{\"samples", "{\"samples\"", "{\"samples\":", "{\"samples\": [[1", "{\"a\\"] {
        assert!(matches!(with_rows_packed(cut.as_bytes()), Cow::Borrowed(_)), "{cut}");
    }
    let said = parse(
        Path::new("r.json"),
        format!("{{\n\"samples\": [{rows}[1, 2]],\n}}").as_bytes(),
        &Budget::default(),
    );
    assert!(said.unwrap_err().to_string().contains("line 3"), "lines are those of the file");
}

#[test]
fn strokes_that_only_press_read_what_others_do_and_refuse_the_rest() {
    let (samples, mut left) = (draw_samples(300, true), 1_000);
    let pressed: Vec<(Vec2, f32)> =
        samples.iter().map(|sample| (sample.at, sample.pressure)).collect();
    let mut read =
        |value: &Value| read_pressed(&JsonNode::root(Path::new("r.json"), value), 500, &mut left);
    for some in [&pressed[..], &pressed[..32], &pressed[..1], &[]] {
        assert_eq!(read(&write_pressed(some)).unwrap(), some);
    }
    assert_eq!(
        write_pressed(&[(vec2(1.0, 2.0), 1.0), (vec2(3.0, 4.0), 0.5)]),
        json!([[1, 2], [3, 4, 0.5]])
    );
    let said = read(&json!([[1, 2, 0.5], [1, 2, 0.5, 9]])).unwrap_err().to_string();
    assert!(said.contains("[1]: has more than a place and a pressure"), "{said}");
    assert!(read(&json!([[1, 2, 2]])).is_err());
}

#[test]
fn damage_is_told_and_asks_for_no_memory() {
    let says = |value: Value, what: &str| {
        let said = read_value(&value).unwrap_err().to_string();
        assert!(said.contains(what), "{said}");
    };
    let text = pack(&draw_samples(100, false));
    says(text[..text.len() - 8].into(), "is no text of readings");
    says((text.clone() + "AAAA").into(), "is no text of readings");
    says("!".into(), "is no text of readings");
    // A few bytes that promise a thousand million readings, all alike.
    let mut bomb = Vec::new();
    put(&mut bomb, 1 << 30);
    bomb.extend([CONSTANT, 0, 0, 0, 0].repeat(COLUMNS));
    says(base64::encode(&bomb).into(), "has more than 1000000 readings");
    let mut samples = draw_samples(100, false);
    samples[7].pressure = 1.5;
    says(pack(&samples).into(), "[7]: has the pressure 1.5; it must be between 0 and 1");
    says(json!([[1, 2, 2]]), "[0]: has the pressure 2");
    let (value, mut left) = (write(&draw_samples(50, false)), 70);
    let node = JsonNode::root(Path::new("r.json"), &value);
    assert!(
        read(&node, 100, &mut left).is_ok() && left == 20 && read(&node, 100, &mut left).is_err()
    );
}
