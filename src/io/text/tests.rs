use super::*;
use crate::paint::{TextAlign, TextStyle};
use crate::raster::picture::Texels;

/// In a font that comes with the program.
fn text(string: &str) -> Text {
    let style = TextStyle { family: "Hack".into(), size: 20.0, ..TextStyle::default() };
    Text::new(string, style)
}

fn layout(text: &Text) -> TextPicture {
    lay_out(text, &Budget::default()).unwrap()
}

/// The inked share of each of so many columns and rows.
fn ink(picture: &Picture, columns: usize, rows: usize) -> Vec<Vec<f32>> {
    let (w, h) = (picture.size.width as usize, picture.size.height as usize);
    let mut sums = vec![vec![0.0; columns]; rows];
    for y in 0..h {
        for x in 0..w {
            sums[y * rows / h][x * columns / w] += picture.linear_at(x, y)[3];
        }
    }
    sums
}

#[test]
fn a_text_is_outlines_in_its_color_and_its_file_shows_the_same() {
    let mut words = text("Ink");
    words.runs[0].style.color = crate::math::srgb::Color { r: 200, g: 40, b: 30, a: 255 };
    let TextPicture { text: words, picture, size, .. } = layout(&words);
    assert!((20.0..60.0).contains(&size.x) && (12.0..30.0).contains(&size.y), "{size}");
    assert!(words.origin.x >= 0.0 && (10.0..20.0).contains(&words.origin.y), "{}", words.origin);
    let Texels::Srgb8(texels) = &picture.texels else { panic!("it is no picture of bytes") };
    let inked: Vec<_> = texels.iter().filter(|texel| texel[3] == 255).collect();
    assert!(inked.len() > 1000 && inked.iter().all(|texel| texel[..3] == [200, 40, 30]));
    let file = picture.encoded.clone().unwrap();
    assert!(
        !String::from_utf8_lossy(file.bytes()).contains("<text"),
        "letters are left in the file"
    );
    let again = svg::decode(Path::new("text.svg"), file.bytes(), &Budget::default()).unwrap();
    assert_eq!(again, picture);
}

#[test]
fn lines_end_where_the_text_or_its_width_says_so() {
    let height = |string: &str| layout(&text(string)).size.y;
    assert!(height("xx\nxx\nxx") > height("xx") + 2.0 * 20.0);
    // Twelve letters of 12.04 px each fit in 150 px.
    let narrow = Text { width: 150.0, ..text("one two three four") };
    let lines = lines(&narrow).unwrap();
    let said: Vec<String> = lines
        .iter()
        .map(|line| line.pieces.iter().map(|run| run.string.as_str()).collect())
        .collect();
    assert_eq!(said, ["one two ", "three four"]);
    let solid = Text { width: 50.0, ..text("abcdefgh") };
    assert_eq!(super::lines(&solid).unwrap().len(), 2, "a long word is broken");
    let dense = Text { width: 50.0, ..text("日本語。文字") };
    let starts: Vec<usize> = super::lines(&dense).unwrap().iter().map(|line| line.start).collect();
    assert!(starts.iter().all(|start| !"日本語。文字"[*start..].starts_with('。')), "{starts:?}");
}

#[test]
fn lines_are_aligned_to_the_left_the_middle_and_the_right() {
    let of = |align| {
        let picture = layout(&Text { align, ..text("wide line\nx") }).picture;
        let [left, middle, right] = ink(&picture, 3, 2)[1][..] else { panic!() };
        [left > 0.0, middle > 0.0, right > 0.0]
    };
    assert_eq!(of(TextAlign::Start), [true, false, false]);
    assert_eq!(of(TextAlign::Middle), [false, true, false]);
    assert_eq!(of(TextAlign::End), [false, false, true]);
}

#[test]
fn columns_run_down_from_the_right_and_an_arc_lowers_its_ends() {
    let column = layout(&Text { vertical: true, ..text("日本") }).size;
    assert!(column.y > 1.5 * column.x, "{column}");
    let arched = layout(&Text { arc: 120.0, ..text("arched letters") }).picture;
    let above = ink(&arched, 3, 2);
    assert!(above[0][1] > above[0][0] && above[1][0] > above[1][1], "{above:?}");
    let hung = layout(&Text { arc: -120.0, ..text("arched letters") }).picture;
    let above = ink(&hung, 3, 2);
    assert!(above[1][1] > above[1][0] && above[0][0] > above[0][1], "{above:?}");
}

#[test]
fn carets_stand_between_letters_and_end_each_line() {
    let carets = carets(&text("ab\n\ncd")).unwrap();
    let bytes: Vec<usize> = carets.iter().map(|caret| caret.byte).collect();
    assert_eq!(bytes, [0, 1, 2, 3, 4, 5, 6]);
    let [a, b, end, empty, c, ..] = carets[..] else { panic!() };
    assert!(a.at.x.abs() < 0.5 && (b.at.x - 12.0).abs() < 0.5 && (end.at.x - 24.1).abs() < 0.5);
    assert_eq!((a.at.y, empty.at.y, c.at.y), (0.0, 24.0, 48.0));
}

/// Hack has no Hebrew; what stands in for it, even boxes, stands from right to left.
#[test]
fn carets_of_hebrew_go_from_right_to_left() {
    let carets = carets(&text("אב")).unwrap();
    let x: Vec<f32> = carets.iter().map(|caret| caret.at.x).collect();
    assert!(x.len() == 3 && x[0] > x[1] && x[1] > x[2] && x[2].abs() < 1.0, "{x:?}");
}

#[test]
fn an_empty_text_a_long_one_and_one_without_its_font_are_no_failures() {
    let empty = layout(&text(""));
    assert_eq!(empty.size, vec2(1.0, 1.0));
    assert!(ink(&empty.picture, 1, 1)[0][0] == 0.0);
    let odd = text("<&>\"'\u{1}\u{0}\tend");
    assert!(layout(&odd).size.x > 50.0);
    let mut lost = text("lost");
    lost.runs[0].style.family = "No Such Font".into();
    assert_eq!(missing_families(&lost), ["No Such Font"]);
    assert!(layout(&lost).size.x > 10.0, "nothing stands in for it");
    let long = text(&"x".repeat(Text::MOST_LETTERS + 1));
    assert!(lay_out(&long, &Budget::default()).unwrap_err().to_string().contains("letters"));
    let run = text("x").runs[0].clone();
    let many = Text { runs: vec![run; Text::MOST_RUNS + 1], ..Text::default() };
    assert!(lay_out(&many, &Budget::default()).unwrap_err().to_string().contains("pieces"));
    assert!(families().contains(&"Hack".to_owned()));
}

#[test]
fn a_text_is_drawn_larger_where_it_is_seen_larger() {
    let picture = layout(&text("O")).picture;
    let twice = picture.enlarged(2).unwrap();
    assert_eq!(twice.size.width, 2 * picture.size.width);
    let shares = ink(&picture, 1, 1)[0][0] * 4.0 / ink(&twice, 1, 1)[0][0];
    assert!((shares - 1.0).abs() < 0.01, "{shares}");
}

#[test]
fn letters_stand_on_their_path_and_carets_between_them() {
    use crate::paint::{PathNode, Subpath, TextPath};
    // A square that is written on from inside to outside: its corner, then up along its right side.
    let corners = [vec2(0.0, 0.0), vec2(0.0, -100.0), vec2(100.0, -100.0), vec2(100.0, 0.0)];
    let nodes = corners.map(PathNode::corner).to_vec();
    let on = |closed, shift, align| {
        let line = Subpath { nodes: nodes.clone(), closed };
        Text { path: Some(TextPath { line, shift }), align, ..text("abcd") }
    };
    let up = on(false, 10.0, TextAlign::Start);
    let places = carets(&up).unwrap();
    assert_eq!(places.len(), 5);
    for caret in &places {
        assert!(caret.at.x.abs() < 0.1 && caret.direction.distance(-Vec2::Y) < 1e-3, "{caret:?}");
    }
    assert!(
        (places[0].at.y + 10.0).abs() < 0.1 && (places[4].at.y + 58.2).abs() < 0.5,
        "{places:?}"
    );
    // The letters are left of the line that goes up.
    let laid = layout(&up);
    let (left, right) = (-laid.text.origin.x, laid.size.x - laid.text.origin.x);
    assert!((-25.0..-10.0).contains(&left) && (0.0..8.0).contains(&right), "{left} {right}");
    // Where an open line ends letters are left out; around a closed one they go on.
    let width = |closed| layout(&on(closed, 280.0, TextAlign::Start)).picture.size;
    assert!(width(false).width * width(false).height < width(true).width * width(true).height);
    // Two lines: the second below the first.
    let path = up.path.clone();
    let second = carets(&Text { path, ..text("a\nb") }).unwrap();
    assert!((second[2].at.x - 24.0).abs() < 0.1 && second[2].line == 1, "{second:?}");
    // A closed line holds a centered text where it begins, however often one goes around.
    for shift in [0.0, 400.0, -800.0] {
        let middle = carets(&on(true, shift, TextAlign::Middle)).unwrap()[2];
        assert!(middle.at.length() < 0.5, "{shift}: {middle:?}");
    }
    // Nothing to run along: nothing is drawn.
    let nowhere = TextPath { line: Subpath::default(), shift: 0.0 };
    let lost = layout(&Text { path: Some(nowhere), ..text("abc") });
    assert_eq!(lost.size, vec2(1.0, 1.0));
}

/// The box of a letter's outline in its column, in sizes of the type: left, top, right, bottom.
fn box_in_column(letter: &str, family: &str) -> [f32; 4] {
    let style = TextStyle { family: family.into(), size: 100.0, ..TextStyle::default() };
    let words = Text { vertical: true, ..Text::new(letter, style) };
    let column = columns::lay(&lines(&words).unwrap()[0]);
    let numbers = column.outlines[0].0.split(|c: char| c.is_alphabetic() || c == ' ');
    let numbers: Vec<f32> = numbers.filter_map(|number| number.parse().ok()).collect();
    let side = |at: usize, of: fn(f32, f32) -> f32| {
        numbers.iter().skip(at).step_by(2).copied().reduce(of).unwrap() / 100.0
    };
    [side(0, f32::min), side(1, f32::min), side(0, f32::max), side(1, f32::max)]
}

#[test]
fn letters_of_lines_are_turned_in_columns_and_stand_around_the_axis() {
    let [left, top, right, bottom] = box_in_column("l", "Hack");
    assert!(bottom - top < right - left, "it stands: {left} {top} {right} {bottom}");
    assert!(left < 0.0 && right > 0.0 && top >= 0.0 && bottom < 0.61);
    let text = Text { vertical: true, ..text("abc") };
    let places: Vec<Vec2> = carets(&text).unwrap().iter().map(|caret| caret.at).collect();
    let steps: Vec<f32> = places.windows(2).map(|pair| pair[1].y - pair[0].y).collect();
    assert!(steps.iter().all(|step| (step - 12.04).abs() < 0.1), "{places:?}");
    let ends = [TextAlign::Start, TextAlign::Middle, TextAlign::End]
        .map(|align| carets(&Text { align, ..text.clone() }).unwrap().last().unwrap().at.y);
    assert!((ends[0] - 36.1).abs() < 0.1 && (ends[1] - 18.06).abs() < 0.1 && ends[2].abs() < 0.1);
}

#[test]
fn japanese_columns_have_the_forms_that_the_font_has_for_them() {
    const FAMILY: &str = "Noto Sans CJK JP";
    if !families().iter().any(|family| family == FAMILY) {
        eprintln!("skipped: {FAMILY} is not installed");
        return;
    }
    let middle = |letter: &str| {
        let [left, top, right, bottom] = box_in_column(letter, FAMILY);
        vec2(0.5 * (left + right), 0.5 * (top + bottom))
    };
    // A comma and a small kana stand in the upper right of their square, which is 1 wide and high.
    for letter in ["、", "。", "ょ", "ッ"] {
        let at = middle(letter);
        assert!(at.x > 0.02 && at.y < 0.56, "{letter}: {at}");
    }
    assert!(middle("本").distance(vec2(0.0, 0.5)) < 0.06);
    // A bracket that opens is at the lower end of its square, and wider than it is high.
    let [left, top, right, bottom] = box_in_column("「", FAMILY);
    assert!(top > 0.4 && right - left > bottom - top, "{left} {top} {right} {bottom}");
    // A long vowel sign stands.
    let [left, top, right, bottom] = box_in_column("ー", FAMILY);
    assert!(bottom - top > 2.0 * (right - left), "{left} {top} {right} {bottom}");
}

#[test]
fn a_font_is_found_by_its_letters_and_a_preferred_family_comes_first() {
    let (bytes, index) = find_font("Aß", &["No such family", "Hack"]).unwrap().read().unwrap();
    assert_eq!((bytes.as_slice(), index), (epaint_default_fonts::HACK_REGULAR, 0));
    assert!(find_font("Aß", &["No such family"]).is_some());
    assert_eq!(find_font("A\u{10fffd}", &["Hack"]), None, "no font has that letter");
}

/// Texts of every kind.
fn samples() -> [Text; 7] {
    use crate::paint::{PathNode, Subpath, TextPath};
    let nodes = [vec2(0.0, 0.0), vec2(120.0, 40.0), vec2(260.0, 0.0)].map(PathNode::corner);
    let line = Subpath { nodes: nodes.to_vec(), closed: false };
    let boxed = Text { width: 150.0, ..text("one two three four five six seven eight") };
    let mut outlined = Text { leading: 0.7, ..boxed.clone() };
    outlined.runs[0].style.outline = 2.5;
    let two_styles =
        Text { align: TextAlign::End, ..boxed.styled(4, 13, |style| style.size = 31.0) };
    [
        boxed.clone(),
        text("lines\nof\ntheir own"),
        Text { path: Some(TextPath { line, shift: 5.0 }), ..text("on a path\nand beneath") },
        Text { vertical: true, width: 90.0, ..text("columns 日本 from the right") },
        Text { align: TextAlign::End, width: 110.0, ..text("אבג דהו זחט יכל מנס") },
        outlined,
        two_styles,
    ]
}

proptest::proptest! {
    #![proptest_config(proptest::test_runner::Config::with_cases(40))]

    #[test]
    fn a_text_that_is_typed_is_the_one_that_is_laid_out_at_once(
        sample in 0..7usize,
        edits in proptest::collection::vec((0..1000usize, 0..9usize), 1..7),
    ) {
        let budget = Budget { side_px: 500, ..Budget::default() };
        let mut text = samples()[sample].clone();
        let mut shown = lay_out(&text, &budget).unwrap();
        for (place, key) in edits {
            let mut letters: Vec<char> = text.string().chars().collect();
            let place = place % (letters.len() + 1);
            match ["a", "W", "g", " ", "\n", "é", "א", "", "本"][key].chars().next() {
                Some(letter) => letters.insert(place, letter),
                None => drop((place < letters.len()).then(|| letters.remove(place))),
            }
            text = text.saying(&letters.into_iter().collect::<String>());
            let typed = lay_out_again(&text, &shown.picture, &budget).unwrap();
            let whole = lay_out(&text, &budget).unwrap();
            assert!(typed.picture == whole.picture, "other texels: {:?}", text.string());
            assert_eq!((&typed.text, typed.size), (&whole.text, whole.size));
            let file = typed.picture.encoded.clone().unwrap();
            assert!(Some(&file) == whole.picture.encoded.as_ref(), "another file");
            let read = svg::decode(Path::new("text.svg"), file.bytes(), &budget).unwrap();
            assert!(read == typed.picture, "its file shows another: {:?}", text.string());
            if let Some(changed) = typed.changed {
                assert_eq!(typed.picture.size, shown.picture.size);
                let width = shown.picture.size.width as usize;
                let [Texels::Srgb8(old), Texels::Srgb8(new)] =
                    [&shown.picture.texels, &typed.picture.texels] else { panic!() };
                for (i, (old, new)) in old.iter().zip(new.iter()).enumerate() {
                    let is_within = changed.contains((i % width) as i32, (i / width) as i32);
                    assert!(is_within || old == new, "beyond {changed:?}: {}", text.string());
                }
            }
            shown = typed;
        }
    }
}

#[test]
fn a_text_that_is_broken_in_lines_shows_its_whole_width() {
    let [boxed, ..] = samples();
    let inked = lay_out_inked(&boxed, &Budget::default()).unwrap();
    assert!(inked.size.x < 148.0 && (150.0..156.0).contains(&layout(&boxed).size.x));
    // One line is as wide as its letters.
    let short = Text { width: 150.0, ..text("short") };
    assert_eq!(layout(&short).size, lay_out_inked(&short, &Budget::default()).unwrap().size);
}

#[test]
fn a_key_paints_the_lines_that_it_changes() {
    let text = Text { width: 200.0, ..text(&"four words a line ".repeat(12)) };
    let shown = layout(&text);
    // In the last line.
    let typed = text.saying(&format!("{}n", text.string()));
    let again = lay_out_again(&typed, &shown.picture, &Budget::default()).unwrap();
    let (changed, size) = (again.changed.unwrap(), again.picture.size);
    assert!(changed.y0 > 0 && 8 * changed.height() < size.height as usize, "{changed:?} of {size}");
    let same = lay_out_again(&typed, &again.picture, &Budget::default()).unwrap();
    assert!(same.changed.is_some_and(Rect::is_empty));
}
