-- SPDX-License-Identifier: MIT OR Apache-2.0
-- Runs the extension beside the program, on a stand-in for Aseprite: lua dist/aseprite/test.lua PROGRAM
-- It shows that the extension asks for nothing that is not in the stand-in, which was written by Aseprite's reference, and
-- that the program does what it is told. It does not show that Aseprite itself behaves as its reference says.

local PROGRAM = assert(arg[1], "name the program")
local HERE = arg[0]:match("^(.*)/") or "."

-- A table that knows what it has, and fails on anything else.
local function strict(name, has, writes)
  return setmetatable({}, {
    __index = function(_, key)
      local value = has[key]
      if value == nil and not (writes or {})[key] then
        error(name .. "." .. tostring(key) .. " is not in the stand-in", 2)
      end
      return value
    end,
    __newindex = function(_, key, value)
      if not (writes or {})[key] then
        error(name .. "." .. tostring(key) .. " cannot be set", 2)
      end
      has[key] = value
    end,
    __len = function()
      return #has
    end,
  })
end

-- PNG without compression, which is all that the stand-in writes.

local function crc(bytes)
  local sum = 0xffffffff
  for i = 1, #bytes do
    sum = sum ~ bytes:byte(i)
    for _ = 1, 8 do
      sum = (sum >> 1) ~ (0xedb88320 & -(sum & 1))
    end
  end
  return sum ~ 0xffffffff
end

local function chunk(kind, bytes)
  return string.pack(">I4", #bytes) .. kind .. bytes .. string.pack(">I4", crc(kind .. bytes))
end

local function png(width, height, rows)
  local raw = "\0" .. table.concat(rows, "\0")
  local a, b = 1, 0
  for i = 1, #raw do
    a = (a + raw:byte(i)) % 65521
    b = (b + a) % 65521
  end
  local stored = "\x78\x01\x01" .. string.pack("<I2I2", #raw, ~#raw & 0xffff) .. raw .. string.pack(">I2I2", b, a)
  return "\x89PNG\r\n\x1a\n"
    .. chunk("IHDR", string.pack(">I4I4BBBBB", width, height, 8, 6, 0, 0, 0))
    .. chunk("IDAT", stored)
    .. chunk("IEND", "")
end

local function read(name)
  local file = io.open(name, "rb")
  local bytes = file and file:read("a")
  if file then
    file:close()
  end
  return bytes
end

-- Aseprite.

local folder = os.tmpname()
os.remove(folder)
local SIDE, FRAMES = 32, 2
local alerts, cels, transactions, saved_visible = {}, {}, 0, nil

-- A ball of one color on nothing, further right in the second frame.
local function rows_of(frame)
  local rows = {}
  for y = 0, SIDE - 1 do
    local row = {}
    for x = 0, SIDE - 1 do
      local inside = (x - 12 - 4 * frame) ^ 2 + (y - 16) ^ 2 < 100
      row[#row + 1] = inside and "\x30\x90\xe0\xff" or "\0\0\0\0"
    end
    rows[#rows + 1] = table.concat(row)
  end
  return rows
end

local layers = {}
local function layer(name)
  local one = strict("layer", { name = name, isVisible = true, isImage = true }, { name = true, isVisible = true })
  layers[#layers + 1] = one
  return one
end
layer("Ball")

local sprite
sprite = strict("sprite", {
  width = SIDE,
  height = SIDE,
  id = math.random(1, 1000000),
  filename = "/pictures/it's a ball.aseprite",
  colorMode = 1,
  frames = { {}, {} },
  layers = layers,
  newLayer = function(self)
    assert(self == sprite and transactions == 1, "a layer is made in a transaction")
    return layer("Layer 1")
  end,
  newCel = function(_, on, frame, image, at)
    assert(on == layers[#layers] and at.x == 0 and at.y == 0)
    cels[frame] = image.file
  end,
}, { colorMode = true })

local current = { sprite = nil, frame = strict("frame", { frameNumber = 2 }) }
local answer = { ok = true, program = PROGRAM }

ColorMode = strict("ColorMode", { RGB = 1, GRAY = 2, INDEXED = 3 })

function Point(x, y)
  return { x = x, y = y }
end

function Image(width, height, mode)
  if type(width) == "table" then
    local bytes = read(width.fromFile)
    if bytes == nil then
      return nil
    end
    local w, h = string.unpack(">I4I4", bytes, 17)
    assert(w == SIDE and h == SIDE, "the size is kept")
    return { file = width.fromFile }
  end
  assert(width == SIDE and height == SIDE and mode == ColorMode.RGB)
  local drawn
  return strict("image", {
    drawSprite = function(_, of, frame)
      assert(of == sprite)
      saved_visible = layers[#layers].isVisible
      drawn = rows_of(frame)
    end,
    saveAs = function(_, name)
      local file = assert(io.open(name, "wb"))
      file:write(png(SIDE, SIDE, drawn))
      file:close()
    end,
  })
end

function Dialog(title)
  assert(type(title) == "string")
  local nothing = function() end
  return strict("dialog", { label = nothing, newrow = nothing, file = nothing, button = nothing, show = nothing, data = answer })
end

app = setmetatable({}, {
  __index = function(_, key)
    local known = {
      os = strict("app.os", { windows = false, macos = false, linux = true }),
      fs = strict("app.fs", {
        tempPath = folder,
        joinPath = function(...)
          return table.concat({ ... }, "/")
        end,
        makeAllDirectories = function(name)
          return os.execute("mkdir -p '" .. name .. "'")
        end,
        fileTitle = function(name)
          return name:match("([^/]*)%.[^/.]*$") or name
        end,
        fileSize = function(name)
          return #read(name)
        end,
        isFile = function(name)
          return read(name) ~= nil
        end,
      }),
      frame = current.frame,
      alert = function(shown)
        alerts[#alerts + 1] = shown.text
      end,
      transaction = function(title, work)
        assert(type(title) == "string")
        transactions = transactions + 1
        work()
        transactions = transactions - 1
      end,
      refresh = function() end,
    }
    if key == "sprite" then
      return current.sprite
    end
    return known[key] or error("app." .. key .. " is not in the stand-in", 2)
  end,
})

-- The window is not opened: its line is noted.
local execute, started = os.execute, {}
os.execute = function(line)
  if line:match("&$") then
    started[#started + 1] = line
    return true
  end
  return execute(line .. " > '" .. folder .. "/said' 2>&1")
end
execute("mkdir -p '" .. folder .. "'")

local commands = {}
dofile(HERE .. "/rilievo.lua")
local plugin = strict("plugin", {
  preferences = { program = "/nowhere/rilievo" },
  newCommand = function(_, row)
    assert(row.group == "file_scripts" and type(row.title) == "string")
    commands[row.id] = row
  end,
})
init(plugin)

local function press(id)
  local before = #alerts
  commands[id].onclick()
  return alerts[before + 1]
end

assert(not commands.RilievoRelight.onenabled(), "nothing to do without a sprite")
assert(press("RilievoRelight") == "Open a sprite first.")
current.sprite = sprite
assert(commands.RilievoRelight.onenabled())
sprite.colorMode = ColorMode.INDEXED
assert(press("RilievoLightFrames"):match("RGB Color"), "new colors need room")
sprite.colorMode = ColorMode.RGB

-- A frame to the window: the program is asked for, and remembered.
answer.ok = false
assert(press("RilievoRelight") == "Rilievo is not installed.")
answer.ok = true
assert(press("RilievoTakeBack"):match("not opened in Rilievo yet"))
assert(plugin.preferences.program == PROGRAM)
assert(press("RilievoRelight") == nil, alerts[#alerts])
assert(#started == 1 and started[1]:match(" open '.*ball%-2%.ora' &$"), started[1])
assert(press("RilievoTakeBack"):match("press Ctrl S"))
local project = started[1]:match("open '(.*)' &$"):gsub("'\\''", "'")
local script = assert(io.open(folder .. "/script", "w"))
script:write('{"in":"file","do":"open","file":"', project, '"}\n')
script:write('{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}\n')
script:write('{"in":"file","do":"save","file":"', project, '"}\n')
script:close()
assert(os.execute("'" .. PROGRAM .. "' replay --force '" .. folder .. "/script'"))
assert(press("RilievoTakeBack") == nil, alerts[#alerts])
assert(read(cels[2]) ~= read(cels[2]:gsub("%-relit", "")), "light fell on the frame")
assert(#layers == 2 and layers[2].name == "Relit in Rilievo" and cels[2] and not cels[1])

-- All frames, twice: the layer is used again, and is not seen while frames are written.
for _ = 1, 2 do
  assert(press("RilievoLightFrames") == nil, alerts[#alerts] .. (read(folder .. "/said") or ""))
  assert(#layers == 2 and layers[2].isVisible and saved_visible == false)
end
for frame = 1, FRAMES do
  assert(read(cels[frame]) ~= read(cels[frame]:gsub("%-lit", "")), "light fell on frame " .. frame)
end
assert(read(cels[1]) ~= read(cels[2]), "each frame has its own")
print("aseprite: " .. FRAMES .. " frames were lit", arg[2] and folder or "")
if not arg[2] then
  execute("rm -r '" .. folder .. "'")
end
