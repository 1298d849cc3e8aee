-- SPDX-License-Identifier: MIT OR Apache-2.0
-- Relight in Rilievo: opens the frame there and takes it back as a layer, or lights every frame without a window.

local LAYER = "Relit in Rilievo"
local preferences
-- The copies that were opened, and how large they were.
local opened = {}

-- What is wrong, in a sentence for the user.
local function refuse(text)
  error({ sentence = text }, 0)
end

-- An argument for the system's shell.
local function quoted(text)
  if app.os.windows then
    return '"' .. text .. '"'
  end
  return "'" .. text:gsub("'", "'\\''") .. "'"
end

-- The command of the program with arguments.
local function command(...)
  local parts = { quoted(preferences.program) }
  for _, argument in ipairs({ ... }) do
    parts[#parts + 1] = argument:match("^[%a-]+$") and argument or quoted(argument)
  end
  return table.concat(parts, " ")
end

-- Runs the program and waits for it; whether it did what it should.
local function runs(...)
  local line = command(...)
  -- The shell of Windows takes off the outer quotes.
  return os.execute(app.os.windows and '"' .. line .. '"' or line) == true
end

-- Starts the program and does not wait.
local function start(...)
  local line = command(...)
  os.execute(app.os.windows and 'start "" ' .. line or line .. " &")
end

-- Makes sure that the program is known; asks for it otherwise.
local function find_program()
  preferences.program = preferences.program or "rilievo"
  if runs("--version") then
    return
  end
  local dialog = Dialog("Rilievo")
  dialog:label{ text = "Where is the program Rilievo?" }
  dialog:newrow()
  dialog:file{ id = "program", open = true, focus = true }
  dialog:button{ id = "ok", text = "OK" }
  dialog:button{ text = "Cancel" }
  dialog:show()
  local data = dialog.data
  if not data.ok or data.program == "" then
    refuse("Rilievo is not installed.")
  end
  preferences.program = data.program
  if not runs("--version") then
    preferences.program = nil
    refuse(data.program .. " is not the program Rilievo.")
  end
end

-- The sprite in front, whose colors can be changed freely.
local function current_sprite()
  local sprite = app.sprite
  if sprite == nil then
    refuse("Open a sprite first.")
  end
  if sprite.colorMode ~= ColorMode.RGB then
    refuse("Light makes new colors: choose Sprite, Color Mode, RGB Color first.")
  end
  return sprite
end

-- The name of a temporary file for a frame of a sprite.
local function file_of(sprite, frame, ending)
  local folder = app.fs.joinPath(app.fs.tempPath, "rilievo-" .. sprite.id)
  app.fs.makeAllDirectories(folder)
  local title = app.fs.fileTitle(sprite.filename)
  return app.fs.joinPath(folder, (title == "" and "sprite" or title) .. "-" .. frame .. ending)
end

-- Writes what a frame shows, without the layer of last time; returns the name of the file.
local function write_frame(sprite, frame)
  local hidden = {}
  for _, layer in ipairs(sprite.layers) do
    if layer.name == LAYER and layer.isVisible then
      hidden[#hidden + 1] = layer
      layer.isVisible = false
    end
  end
  local image = Image(sprite.width, sprite.height, ColorMode.RGB)
  image:drawSprite(sprite, frame)
  for _, layer in ipairs(hidden) do
    layer.isVisible = true
  end
  local file = file_of(sprite, frame, ".png")
  image:saveAs(file)
  return file
end

-- Puts pictures on the layer for what comes back, by frame: the layer of last time, or a new one above all.
local function put(sprite, files)
  local images = {}
  for frame, file in pairs(files) do
    images[frame] = Image{ fromFile = file } or refuse("Aseprite cannot read " .. file .. ".")
  end
  app.transaction("Relight in Rilievo", function()
    local relit
    for _, layer in ipairs(sprite.layers) do
      if layer.name == LAYER and layer.isImage then
        relit = layer
      end
    end
    if relit == nil then
      relit = sprite:newLayer()
      relit.name = LAYER
    end
    for frame, image in pairs(images) do
      sprite:newCel(relit, frame, image, Point(0, 0))
    end
  end)
  app.refresh()
end

-- Opens the frame in Rilievo.
local function relight()
  local sprite = current_sprite()
  find_program()
  local frame = app.frame.frameNumber
  local project = file_of(sprite, frame, ".ora")
  if not runs("convert", "--force", write_frame(sprite, frame), project) then
    refuse("Rilievo cannot read the frame.")
  end
  opened[project] = app.fs.fileSize(project)
  start("open", project)
end

-- Takes back what was saved there.
local function take_back()
  local sprite = current_sprite()
  find_program()
  local frame = app.frame.frameNumber
  local project = file_of(sprite, frame, ".ora")
  if not app.fs.isFile(project) then
    refuse("This frame was not opened in Rilievo yet: choose Relight in Rilievo.")
  end
  if opened[project] == app.fs.fileSize(project) then
    refuse("Nothing was saved in Rilievo yet: press Ctrl S there.")
  end
  local file = file_of(sprite, frame, "-relit.png")
  if not runs("convert", "--force", project, file) then
    refuse("Rilievo cannot read what was saved.")
  end
  put(sprite, { [frame] = file })
end

-- Text as JSON.
local function json(text)
  return '"' .. text:gsub('[\\"]', "\\%0") .. '"'
end

-- Gives every frame a shape of its own and light in three tones, without a window.
local function light_frames()
  local sprite = current_sprite()
  find_program()
  local files, lines = {}, {}
  for frame = 1, #sprite.frames do
    files[frame] = file_of(sprite, frame, "-lit.png")
    lines[#lines + 1] = '{"in":"file","do":"open","file":' .. json(write_frame(sprite, frame)) .. "}"
    lines[#lines + 1] = '{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}'
    lines[#lines + 1] = '{"in":"file","do":"export","file":' .. json(files[frame]) .. ',"quality":92}'
    lines[#lines + 1] = '{"in":"file","do":"close","index":0}'
  end
  local script = file_of(sprite, 0, ".jsonl")
  local file = io.open(script, "w")
  if file == nil then
    refuse("Aseprite cannot write " .. script .. ".")
  end
  file:write(table.concat(lines, "\n"), "\n")
  file:close()
  if not runs("replay", "--force", script) then
    refuse("Rilievo cannot light the frames.")
  end
  put(sprite, files)
end

-- Does something, and shows in a sentence why it cannot be done.
local function try(work)
  return function()
    local done, failure = pcall(work)
    if not done then
      app.alert{ title = "Rilievo", text = type(failure) == "table" and failure.sentence or tostring(failure) }
    end
  end
end

local function has_sprite()
  return app.sprite ~= nil
end

function init(plugin)
  preferences = plugin.preferences
  for _, row in ipairs({
    { "RilievoRelight", "Relight in Rilievo", relight },
    { "RilievoTakeBack", "Take back from Rilievo", take_back },
    { "RilievoLightFrames", "Light all frames in three tones", light_frames },
  }) do
    plugin:newCommand{ id = row[1], title = row[2], group = "file_scripts", onclick = try(row[3]), onenabled = has_sprite }
  end
end

function exit(_)
end
