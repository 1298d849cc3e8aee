//! Writes descriptors, one value after another. Floor 5.

use crate::math::srgb::Color;

/// The values of an object in the making.
#[derive(Default)]
pub struct DescriptorWriter {
    count: u32,
    values: Vec<u8>,
}

impl DescriptorWriter {
    /// Names of four letters are written without their length.
    fn name(&mut self, name: &str) {
        self.count += 1;
        put_name(&mut self.values, name);
    }

    pub fn whole(&mut self, name: &str, value: f32) {
        self.name(name);
        self.values.extend(b"long");
        self.values.extend((value.round() as i32).to_be_bytes());
    }

    pub fn double(&mut self, name: &str, value: f64) {
        self.name(name);
        self.values.extend(b"doub");
        self.values.extend(value.to_be_bytes());
    }

    /// A number of a unit: `#Prc`, `#Pxl`, `#Ang`.
    pub fn measure(&mut self, name: &str, unit: &str, value: f64) {
        self.name(name);
        self.values.extend(b"UntF");
        self.values.extend(unit.as_bytes());
        self.values.extend(value.to_be_bytes());
    }

    pub fn flag(&mut self, name: &str, value: bool) {
        self.name(name);
        self.values.extend(b"bool");
        self.values.push(u8::from(value));
    }

    /// One of the choices of a kind.
    pub fn word(&mut self, name: &str, kind: &str, word: &str) {
        self.name(name);
        self.values.extend(b"enum");
        put_name(&mut self.values, kind);
        put_name(&mut self.values, word);
    }

    pub fn text(&mut self, name: &str, text: &str) {
        self.name(name);
        self.values.extend(b"TEXT");
        let units: Vec<u16> = text.encode_utf16().chain([0]).collect();
        self.values.extend((units.len() as u32).to_be_bytes());
        units.iter().for_each(|unit| self.values.extend(unit.to_be_bytes()));
    }

    pub fn object(&mut self, name: &str, class: &str, inner: DescriptorWriter) {
        self.name(name);
        self.values.extend(b"Objc");
        inner.put(&mut self.values, class);
    }

    pub fn objects(&mut self, name: &str, class: &str, list: Vec<DescriptorWriter>) {
        self.name(name);
        self.values.extend(b"VlLs");
        self.values.extend((list.len() as u32).to_be_bytes());
        for inner in list {
            self.values.extend(b"Objc");
            inner.put(&mut self.values, class);
        }
    }

    /// A list of numbers of a unit.
    pub fn measures(&mut self, name: &str, unit: &str, list: &[f64]) {
        self.name(name);
        self.values.extend(b"VlLs");
        self.values.extend((list.len() as u32).to_be_bytes());
        for value in list {
            self.values.extend(b"UntF");
            self.values.extend(unit.as_bytes());
            self.values.extend(value.to_be_bytes());
        }
    }

    pub fn color(&mut self, name: &str, color: Color) {
        let mut inner = DescriptorWriter::default();
        for (name, byte) in [("Rd  ", color.r), ("Grn ", color.g), ("Bl  ", color.b)] {
            inner.double(name, f64::from(byte));
        }
        self.object(name, "RGBC", inner);
    }

    /// An object: no name, its class, its values.
    fn put(self, out: &mut Vec<u8>, class: &str) {
        out.extend([0, 0, 0, 1, 0, 0]);
        put_name(out, class);
        out.extend(self.count.to_be_bytes());
        out.extend(self.values);
    }

    /// The descriptor after its version.
    pub fn into_bytes(self) -> Vec<u8> {
        self.into_bytes_of("null")
    }

    /// The same of a class.
    pub fn into_bytes_of(self, class: &str) -> Vec<u8> {
        const VERSION: u32 = 16;
        let mut out = VERSION.to_be_bytes().to_vec();
        self.put(&mut out, class);
        out
    }
}

fn put_name(out: &mut Vec<u8>, name: &str) {
    let length = if name.len() == 4 { 0 } else { name.len() as u32 };
    out.extend(length.to_be_bytes());
    out.extend(name.as_bytes());
}
