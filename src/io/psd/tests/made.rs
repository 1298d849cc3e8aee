//! Small Photoshop files, laid out byte by byte as the format says, for what our own writer never
//! writes.

/// A file in the making.
pub struct Made {
    /// The number of its kind of colors.
    pub mode: u16,
    pub bits: u16,
    pub width: u32,
    pub height: u32,
    pub table: Vec<u8>,
    pub resources: Vec<(u16, Vec<u8>)>,
    /// Bottom first; `None`: no layers at all.
    pub layers: Option<Vec<MadeLayer>>,
    /// Blocks of the whole file.
    pub blocks: Vec<(&'static [u8; 4], Vec<u8>)>,
    /// The picture's planes, plain.
    pub merged: Vec<Vec<u8>>,
}

/// A layer of 8 bits, its channels plain.
#[derive(Clone, Default)]
pub struct MadeLayer {
    pub name: &'static str,
    pub blend: [u8; 4],
    pub is_clipped: bool,
    /// Top, left, bottom, right.
    pub rect: [i32; 4],
    pub channels: Vec<(i16, Vec<u8>)>,
    pub mask_data: Vec<u8>,
    pub ranges: Vec<u8>,
    pub blocks: Vec<(&'static [u8; 4], Vec<u8>)>,
}

/// One opaque color on a canvas, its picture the same.
pub fn plain(width: u32, height: u32, rgb: [u8; 3]) -> Made {
    let area = (width * height) as usize;
    Made {
        mode: 3,
        bits: 8,
        width,
        height,
        table: Vec::new(),
        resources: Vec::new(),
        layers: Some(vec![colored_layer("ground", width, height, rgb)]),
        blocks: Vec::new(),
        merged: rgb.map(|v| vec![v; area]).to_vec(),
    }
}

/// An opaque layer of the canvas's size.
pub fn colored_layer(name: &'static str, width: u32, height: u32, rgb: [u8; 3]) -> MadeLayer {
    let area = (width * height) as usize;
    let channels = (0..3).map(|c| (c as i16, vec![rgb[c]; area])).collect();
    MadeLayer {
        name,
        blend: *b"norm",
        rect: [0, 0, height as i32, width as i32],
        channels,
        ..MadeLayer::default()
    }
}

/// A layer without pixels, with blocks.
pub fn empty(name: &'static str, blocks: Vec<(&'static [u8; 4], Vec<u8>)>) -> MadeLayer {
    MadeLayer { name, blend: *b"norm", blocks, ..MadeLayer::default() }
}

fn with_length(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_be_bytes(), bytes].concat()
}

fn block((key, data): &(&'static [u8; 4], Vec<u8>)) -> Vec<u8> {
    [b"8BIM".as_slice(), *key, &with_length(data)].concat()
}

impl MadeLayer {
    fn record(&self) -> Vec<u8> {
        let mut out: Vec<u8> = self.rect.iter().flat_map(|side| side.to_be_bytes()).collect();
        out.extend((self.channels.len() as u16).to_be_bytes());
        for (id, data) in &self.channels {
            out.extend(id.to_be_bytes());
            out.extend((data.len() as u32 + 2).to_be_bytes());
        }
        out.extend(b"8BIM");
        out.extend(self.blend);
        out.extend([255, u8::from(self.is_clipped), 0, 0]);
        let mut name = [&[self.name.len() as u8], self.name.as_bytes()].concat();
        name.resize(name.len().next_multiple_of(4), 0);
        let blocks: Vec<u8> = self.blocks.iter().flat_map(block).collect();
        out.extend(with_length(
            &[with_length(&self.mask_data), with_length(&self.ranges), name, blocks].concat(),
        ));
        out
    }
}

impl Made {
    pub fn bytes(&self) -> Vec<u8> {
        let mut out = b"8BPS\0\x01\0\0\0\0\0\0".to_vec();
        out.extend((self.merged.len() as u16).to_be_bytes());
        out.extend([self.height.to_be_bytes(), self.width.to_be_bytes()].concat());
        out.extend([self.bits.to_be_bytes(), self.mode.to_be_bytes()].concat());
        out.extend(with_length(&self.table));
        let resource = |(id, data): &(u16, Vec<u8>)| {
            let mut data = with_length(data);
            data.resize(data.len().next_multiple_of(2), 0);
            [b"8BIM".as_slice(), &id.to_be_bytes(), &[0, 0], &data].concat()
        };
        out.extend(with_length(&self.resources.iter().flat_map(resource).collect::<Vec<u8>>()));
        out.extend(with_length(&self.section()));
        // Plain.
        out.extend([0, 0]);
        out.extend(self.merged.concat());
        out
    }

    fn section(&self) -> Vec<u8> {
        let Some(layers) = &self.layers else { return Vec::new() };
        let mut info = (layers.len() as i16).to_be_bytes().to_vec();
        info.extend(layers.iter().flat_map(MadeLayer::record));
        for (_, data) in layers.iter().flat_map(|layer| &layer.channels) {
            info.extend([0, 0]);
            info.extend(data);
        }
        info.resize(info.len().next_multiple_of(4), 0);
        [with_length(&info), with_length(&[]), self.blocks.iter().flat_map(block).collect()]
            .concat()
    }
}

/// A descriptor behind its version.
pub fn descriptor(values: &[(&str, Vec<u8>)]) -> Vec<u8> {
    [&16u32.to_be_bytes()[..], &object(values)].concat()
}

/// An object without its kind: no name, a class, its values.
pub fn object(values: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut out = [&[0; 4][..], &[0; 4], b"null", &(values.len() as u32).to_be_bytes()].concat();
    for (name, value) in values {
        out.extend(word(name));
        out.extend(value);
    }
    out
}

fn word(text: &str) -> Vec<u8> {
    let length = if text.len() == 4 { 0 } else { text.len() as u32 };
    [&length.to_be_bytes()[..], text.as_bytes()].concat()
}

pub fn objc(values: &[(&str, Vec<u8>)]) -> Vec<u8> {
    [b"Objc".as_slice(), &object(values)].concat()
}

pub fn list(values: &[Vec<u8>]) -> Vec<u8> {
    [b"VlLs".as_slice(), &(values.len() as u32).to_be_bytes(), &values.concat()].concat()
}

pub fn double(value: f64) -> Vec<u8> {
    [b"doub".as_slice(), &value.to_be_bytes()].concat()
}

pub fn percent(value: f64) -> Vec<u8> {
    [b"UntF#Prc".as_slice(), &value.to_be_bytes()].concat()
}

pub fn long(value: i32) -> Vec<u8> {
    [b"long".as_slice(), &value.to_be_bytes()].concat()
}

pub fn flag(value: bool) -> Vec<u8> {
    [b"bool".as_slice(), &[u8::from(value)]].concat()
}

pub fn choice(kind: &str, value: &str) -> Vec<u8> {
    [b"enum".to_vec(), word(kind), word(value)].concat()
}

pub fn text(value: &str) -> Vec<u8> {
    let units: Vec<u8> = value.encode_utf16().flat_map(u16::to_be_bytes).collect();
    [b"TEXT".as_slice(), &(value.len() as u32).to_be_bytes(), &units].concat()
}

pub fn rgb([r, g, b]: [u8; 3]) -> Vec<u8> {
    objc(&[("Rd  ", double(r.into())), ("Grn ", double(g.into())), ("Bl  ", double(b.into()))])
}
