-- Wireshark and tshark read the wire of a FATEK PLC with this file: FACON, M-series and Modbus frames in the
-- captures that `fatektool … --trace line.pcap` writes, and FACON over TCP and UDP.
--
-- Once:    wireshark -X lua_script:fatek.lua line.pcap
--          tshark -X lua_script:fatek.lua -r line.pcap -V
-- Always:  copy it into the folder "Personal Lua Plugins" of Help > About Wireshark > Folders
--          (Linux: ~/.local/lib/wireshark/plugins), and start Wireshark again or press Ctrl+Shift+L.
--
-- Captures have link type 147 (USER0), and nothing needs to be set for it. For FACON over Ethernet choose
-- Analyze > Decode As: TCP or UDP port 500, FACON (tshark: -d tcp.port==500,facon).
--
-- Useful filters:  fatek.command == 0x4f && fatek.page == 5     fatek.element == "R12"     fatek.error > 0
--                  fatek.checksum.status == 0                   fatek.malformed            fatek.time > 0.1
--
-- One file, so that one copy installs it. Written from the protocols' papers, apart from fatektool, in what Lua
-- 5.2 to 5.4 have in common; tried on Wireshark 4.0.

-- What the papers list ------------------------------------------------------------------------------------

local COMMANDS = {
  [0x40] = "brief status", [0x41] = "run/stop", [0x42] = "control one discrete", [0x43] = "read enable status",
  [0x44] = "read discretes", [0x45] = "write discretes", [0x46] = "read registers", [0x47] = "write registers",
  [0x48] = "mixed read", [0x49] = "mixed write", [0x4E] = "loopback", [0x4F] = "read program page",
  [0x50] = "write program page", [0x53] = "detailed status",
}
local ERRORS = {
  [0x0] = "none", [0x2] = "illegal value", [0x3] = "write prohibited, a ROM pack is fitted",
  [0x4] = "illegal format or command, or it cannot be executed now",
  [0x5] = "cannot run, ladder checksum error", [0x6] = "cannot run, PLC ID differs from ladder ID",
  [0x7] = "cannot run, syntax error in the program", [0x9] = "cannot run, instruction not supported",
  [0xA] = "illegal address",
}
local MSERIES_ERRORS = { -- that paper's own: no 3, and another 9
  [0x0] = "none", [0x2] = "illegal value", [0x4] = "illegal format, or a command that cannot be executed",
  [0x5] = "cannot run, ladder checksum error", [0x6] = "cannot run, PLC ID differs from ladder ID",
  [0x7] = "cannot run, syntax error in the program", [0x9] = "cannot run, function not supported",
  [0xA] = "illegal address",
}
local CONTROLS = { [1] = "disable", [2] = "enable", [3] = "set", [4] = "reset" }
local MODELS = {
  [0xFF] = "FB, 8K steps", [0x53] = "FBE, 8K steps", [0x54] = "FBE, 13K steps",
  [0x55] = "FBN, 8K steps", [0x56] = "FBN, 13K steps",
}
local PROTOCOLS = { [1] = "FACON", [2] = "M-series", [3] = "Modbus RTU", [4] = "Modbus ASCII", [5] = "Modbus TCP" }
local SIZES = { -- bytes 5 to 28 of a detailed status, two bytes each
  "ladder_words", "discrete_inputs", "discrete_outputs", "analog_inputs", "analog_outputs", "m_relays",
  "s_relays", "l_relays", "r_registers", "d_registers", "timers", "counters",
}

-- symbol -> bits of a value, distance of neighbours, digits of an address in FACON (F and DF are M-series' alone)
local KINDS = {}
for _, symbol in ipairs { "X", "Y", "M", "S", "T", "C" } do
  KINDS[symbol] = { bits = 1, stride = 1, digits = 4 }
  KINDS["W" .. symbol] = { bits = 16, stride = 16, digits = 4 }
  KINDS["DW" .. symbol] = { bits = 32, stride = 32, digits = 4 }
end
for symbol, digits in pairs { RT = 4, RC = 4, R = 5, D = 5, F = false } do
  KINDS[symbol] = { bits = 16, stride = 1, digits = digits }
  KINDS["D" .. symbol] = { bits = 32, stride = 2, digits = digits }
end

-- Protocols and fields ------------------------------------------------------------------------------------

local made, fatek = pcall(Proto, "fatek", "FATEK PLC")
if not made then return end -- loaded already: from the plugin folder, and once more by -X lua_script
local facon = Proto("facon", "FATEK FACON") -- the same frames over TCP and UDP

local F = {
  version = ProtoField.uint8("fatek.version", "Version"),
  direction = ProtoField.uint8("fatek.direction", "Direction", base.DEC, { [0] = "sent", [1] = "received" }),
  protocol = ProtoField.uint8("fatek.protocol", "Protocol", base.DEC, PROTOCOLS),
  role = ProtoField.string("fatek.role", "Role"),
  station = ProtoField.uint8("fatek.station", "Station"),
  command = ProtoField.uint8("fatek.command", "Command", base.HEX, COMMANDS),
  error = ProtoField.uint8("fatek.error", "Error", base.HEX),
  length = ProtoField.uint16("fatek.length", "Payload length"),
  run = ProtoField.uint8("fatek.run", "Run", base.DEC, { [0] = "STOP", [1] = "RUN" }),
  control = ProtoField.uint8("fatek.control", "Control", base.DEC, CONTROLS),
  count = ProtoField.uint16("fatek.count", "Count"),
  element = ProtoField.string("fatek.element", "Element"),
  value = ProtoField.string("fatek.value", "Value"),
  page = ProtoField.uint16("fatek.page", "Page"),
  page_data = ProtoField.bytes("fatek.page_data", "Program words"),
  loopback = ProtoField.bytes("fatek.loopback", "Loopback data"),
  data = ProtoField.bytes("fatek.data", "Data"),
  noise = ProtoField.bytes("fatek.noise", "No frame"),
  status = ProtoField.uint8("fatek.status", "Status byte 1", base.HEX),
  running = ProtoField.bool("fatek.status.running", "Mode", 8, { "RUN", "STOP" }, 0x01),
  battery = ProtoField.bool("fatek.status.battery_low", "Battery low", 8, nil, 0x02),
  ladder = ProtoField.bool("fatek.status.ladder_checksum_error", "Ladder checksum error", 8, nil, 0x04),
  rom = ProtoField.bool("fatek.status.rom_pack", "ROM pack or memory card", 8, nil, 0x08),
  watchdog = ProtoField.bool("fatek.status.watchdog_timeout", "Watchdog timed out", 8, nil, 0x10),
  id = ProtoField.bool("fatek.status.id_set", "ID set", 8, nil, 0x20),
  emergency = ProtoField.bool("fatek.status.emergency_stop", "Emergency stop", 8, nil, 0x40),
  model = ProtoField.uint8("fatek.model", "Model", base.HEX, MODELS),
  unit_type = ProtoField.uint8("fatek.unit_type", "Main unit type", base.HEX, { [0] = "MA/MU", [1] = "MC" }),
  unit_points = ProtoField.uint8("fatek.unit_points", "Main unit points, code", base.HEX),
  os = ProtoField.string("fatek.os_version", "OS version"),
  lrc = ProtoField.uint8("fatek.lrc", "LRC", base.HEX),
  lrc_expected = ProtoField.uint8("fatek.lrc.expected", "LRC computed", base.HEX),
  crc = ProtoField.uint16("fatek.crc", "CRC", base.HEX),
  crc_expected = ProtoField.uint16("fatek.crc.expected", "CRC computed", base.HEX),
  checksum = ProtoField.uint8("fatek.checksum.status", "Checksum", base.DEC, { [0] = "bad", [1] = "good" }),
  answer_in = ProtoField.framenum("fatek.answer_in", "Answer in", base.NONE, frametype.RESPONSE),
  answer_to = ProtoField.framenum("fatek.answer_to", "Answer to", base.NONE, frametype.REQUEST),
  time = ProtoField.relative_time("fatek.time", "Time since the request"),
}
for _, name in ipairs(SIZES) do
  F[name] = ProtoField.uint16("fatek." .. name, (name:gsub("_", " "):gsub("^%l", string.upper)))
end
local E = {
  checksum = ProtoExpert.new("fatek.checksum.bad", "Bad checksum", expert.group.CHECKSUM, expert.severity.ERROR),
  malformed = ProtoExpert.new("fatek.malformed", "No frame", expert.group.MALFORMED, expert.severity.ERROR),
  data = ProtoExpert.new("fatek.data.bad", "Bad data", expert.group.PROTOCOL, expert.severity.WARN),
  refused = ProtoExpert.new("fatek.refused", "Refused", expert.group.RESPONSE_CODE, expert.severity.WARN),
  unasked = ProtoExpert.new("fatek.unasked", "No request for it", expert.group.SEQUENCE, expert.severity.NOTE),
}
fatek.fields, fatek.experts = F, E

-- A reader takes the data field of a frame apart, from the left -------------------------------------------
-- What the two protocols write differently is in `errors`, `code`, `short`, `widths`, `number` and `element`.

local Reader = {}
Reader.__index = Reader

function Reader:left()
  return self.stop - self.at
end

function Reader:take(size)
  if self:left() < size then error("the data end too early", 0) end
  local range = self.tvb(self.at, size)
  self.at = self.at + size
  return range
end

function Reader:rest()
  return self:left() > 0 and self:take(self:left()) or nil
end

function Reader:value(element, states) -- states: how a discrete's 0 and 1 are shown
  local value, range = self:number(self.widths[element.bits])
  return element.bits == 1 and states[math.min(value, 1)] or tostring(value), range
end

-- FACON: hex digits, and decimal addresses
local Text = setmetatable({ errors = ERRORS, code = 1, short = 2, page = 4, widths = { [1] = 1, [16] = 4, [32] = 8 } }, Reader)
Text.__index = Text

function Text:number(digits)
  local range = self:take(digits)
  local text = range:raw()
  if not text:match("^[0-9A-F]+$") then error("expected hex digits", 0) end
  return tonumber(text, 16), range
end

function Text:element()
  local symbol = self.tvb(self.at, math.min(4, self:left())):raw():match("^%u+") or ""
  local kind = KINDS[symbol]
  if not kind or not kind.digits then error("expected an element", 0) end
  local range = self:take(#symbol + kind.digits)
  local address = range:raw():match("^%u+(%d+)$")
  if not address then error("expected an element", 0) end
  return { symbol = symbol, address = tonumber(address), bits = kind.bits, stride = kind.stride }, range
end

function Text:binary(size) -- hex digits as the bytes that they are, in a pane of their own
  local range = self:take(2 * size)
  local text = range:raw()
  if not text:match("^[0-9A-F]+$") then error("expected hex digits", 0) end
  return ByteArray.new(text):tvb("FACON data"):range()
end

-- M-series: numbers and addresses as bytes
local Binary = setmetatable({ errors = MSERIES_ERRORS, code = 1, short = 1, page = 2, widths = { [1] = 1, [16] = 2, [32] = 4 } }, Reader)
Binary.__index = Binary

function Binary:number(size)
  local range = self:take(size)
  return range:uint(), range
end

function Binary:element()
  for length = math.min(3, self:left()), 1, -1 do -- the longest symbol that matches
    local symbol = self.tvb(self.at, length):raw()
    local kind = KINDS[symbol]
    if kind then
      local range = self:take(length + 2)
      return { symbol = symbol, address = range(length, 2):uint(), bits = kind.bits, stride = kind.stride }, range
    end
  end
  error("expected an element", 0)
end

function Binary:binary(size)
  return self:take(size)
end

-- The data of requests ------------------------------------------------------------------------------------
-- Each gives what is asked in words and, for a read, the elements whose values the answer will hold.

local function name_of(element, place)
  return element.symbol .. (element.address + (place or 0) * element.stride)
end

local function add_count(reader, tree, whole)
  local count, range = reader:number(reader.short)
  if count == 0 and whole then count = 256 end
  tree:add(F.count, range, count)
  return count
end

local function add_elements(reader, tree, whole)
  local count = add_count(reader, tree, whole)
  local first, range = reader:element()
  local words = name_of(first)
  local item = tree:add(F.element, range, words)
  if count > 1 then
    words = words .. ".." .. name_of(first, count - 1)
    item:append_text(" to " .. name_of(first, count - 1))
  end
  local elements = {}
  for place = 0, count - 1 do
    elements[place + 1] = { name = name_of(first, place), bits = first.bits }
  end
  return words, elements
end

local ON_OFF, DISABLED = { [0] = "off", [1] = "on" }, { [0] = "enabled", [1] = "disabled" }

local function add_values(reader, tree, elements, states)
  local shown = {}
  for place, element in ipairs(elements) do
    local value, range = reader:value(element, states or ON_OFF)
    tree:add(F.value, range, element.name .. " = " .. value)
    shown[place] = value
  end
  return shown
end

local function add_mixed(reader, tree, with_values)
  local names, elements = {}, {}
  for place = 1, add_count(reader, tree) do
    local element, range = reader:element()
    local named = { name = name_of(element), bits = element.bits }
    tree:add(F.element, range, named.name)
    if with_values then add_values(reader, tree, { named }) end
    names[place], elements[place] = named.name, named
  end
  if #names > 4 then names = { names[1], names[2], names[3], "… (" .. #elements .. ")" } end
  return table.concat(names, ", "), elements
end

local function add_page(reader, tree)
  local page, range = reader:number(reader.page)
  local item = tree:add(F.page, range, page)
  if page == 0 then item:append_text(", the header") end
  return "page " .. page
end

local function reads(words, whole)
  return function(reader, tree)
    local span, elements = add_elements(reader, tree, whole)
    return words .. " " .. span, elements
  end
end

local function writes(whole)
  return function(reader, tree)
    local span, elements = add_elements(reader, tree, whole)
    add_values(reader, tree, elements)
    return "write " .. span
  end
end

local function add_loopback(reader, tree)
  local size, range = reader:left(), reader:rest()
  if range then tree:add(F.loopback, range) end
  return "loopback of " .. size .. " bytes"
end

local REQUESTS = {
  [0x40] = function() return "read brief status" end,
  [0x41] = function(reader, tree)
    local run, range = reader:number(reader.code)
    tree:add(F.run, range, run)
    return run == 1 and "RUN" or run == 0 and "STOP" or error("expected 1 or 0", 0)
  end,
  [0x42] = function(reader, tree)
    local control, code = reader:number(reader.code)
    tree:add(F.control, code, control)
    local element, range = reader:element()
    tree:add(F.element, range, name_of(element))
    return (CONTROLS[control] or error("expected a control code of 1 to 4", 0)) .. " " .. name_of(element)
  end,
  [0x43] = reads("read enable status of", true),
  [0x44] = reads("read", true),
  [0x45] = writes(true),
  [0x46] = reads("read"),
  [0x47] = writes(),
  [0x48] = function(reader, tree)
    local words, elements = add_mixed(reader, tree)
    return "read " .. words, elements
  end,
  [0x49] = function(reader, tree) return "write " .. add_mixed(reader, tree, true) end,
  [0x4E] = add_loopback,
  [0x4F] = function(reader, tree) return "read " .. add_page(reader, tree) end,
  [0x50] = function(reader, tree)
    local words = add_page(reader, tree)
    tree:add(F.page_data, reader:binary(128))
    return "write " .. words
  end,
  [0x53] = function() return "read detailed status" end,
}

-- The data of answers -------------------------------------------------------------------------------------

local function add_flags(tree, byte)
  local flags = tree:add(F.status, byte)
  for _, name in ipairs { "running", "battery", "ladder", "rom", "watchdog", "id", "emergency" } do
    flags:add(F[name], byte)
  end
  return byte:uint() % 2 == 1 and "RUN" or "STOP"
end

local ANSWERS = {
  [0x40] = function(reader, tree)
    local bytes = reader:binary(3)
    tree:add(F.model, bytes(1, 1))
    return add_flags(tree, bytes(0, 1))
  end,
  [0x4F] = function(reader, tree)
    tree:add(F.page_data, reader:binary(128))
  end,
  [0x53] = function(reader, tree)
    local bytes = reader:binary(64)
    local mode = add_flags(tree, bytes(0, 1))
    tree:add(F.unit_type, bytes(1, 1))
    tree:add(F.unit_points, bytes(2, 1))
    local os = bytes(3, 1):uint()
    tree:add(F.os, bytes(3, 1), math.floor(os / 16) .. "." .. os % 16)
    for place, name in ipairs(SIZES) do
      tree:add(F[name], bytes(2 + 2 * place, 2))
    end
    return mode .. ", " .. bytes(4, 2):uint() .. " ladder words"
  end,
}
local WHOLE = { [0x4F] = 256, [0x53] = 128 } -- FACON answers that may come without an error character

local function add_answer(reader, tree, command, request)
  local words = request and request.words or ("%02X"):format(command)
  if command == 0x4E then
    add_loopback(reader, tree)
    return words
  end
  if reader.short == 1 or reader:left() ~= WHOLE[command] then
    local code, range = reader:number(reader.code)
    local item = tree:add(F.error, range, code)
    local meaning = reader.errors[code] or "a code that no paper lists"
    item:append_text(" (" .. meaning .. ")")
    if code ~= 0 then
      item:add_proto_expert_info(E.refused, "Refused: " .. meaning)
      return words .. " REFUSED: " .. meaning
    end
  end
  local add, found = ANSWERS[command], nil
  if add then
    found = add(reader, tree)
  elseif request and request.elements then
    local values = add_values(reader, tree, request.elements, command == 0x43 and DISABLED)
    if #values <= 4 then found = table.concat(values, ", ") end
  elseif command >= 0x43 and command <= 0x48 and reader:left() > 0 then
    tree:add(F.data, reader:rest()):append_text(" (values of elements that the request names)")
  end
  return found and words .. ": " .. found or words
end

-- Which answer belongs to which request -------------------------------------------------------------------

local pending, seen = {}, {} -- by line, station and command; by packet and place in it
function fatek.init()
  pending, seen = {}, {}
end

-- A frame between its checksum and its start is read here, for both protocols.
-- frame: protocol, station, command (each with its range), reader, raw (hex), good (its checksum), tree
local function dissect_frame(frame, pinfo, context)
  local tree, command = frame.tree, frame.command
  tree:add(F.station, frame.station_range, frame.station)
  tree:add(F.command, frame.command_range, command)
  context.place = context.place + 1
  local key = ("%s %d %d"):format(context.line, frame.station, command)
  local mark = pinfo.number .. " " .. context.place
  if not pinfo.visited then -- later visits come in any order
    local request = pending[key]
    local note = { role = context.request and "request" or "answer" }
    if not context.request then
      if request and request.raw == frame.raw and command ~= 0x4E and command ~= 0x41 then
        note.role = "echo" -- of a two-wire line; that of 4E and 41 looks like their answer
      elseif frame.good then
        note.request, pending[key] = request, nil
        if request then
          request.answer = pinfo.number
          note.late = pinfo.rel_ts - request.time
        end
      end
    end
    seen[mark] = note
  end
  local note = seen[mark]
  tree:add(F.role, note.role):set_generated()
  local words, elements
  local ok, failure = pcall(function()
    local read = REQUESTS[command]
    if note.role == "answer" then
      words = add_answer(frame.reader, tree, command, note.request)
    elseif read then
      words, elements = read(frame.reader, tree)
    else
      error("a command that no paper lists", 0)
    end
    if frame.reader:left() > 0 then error(frame.reader:left() .. " bytes too many", 0) end
  end)
  local rest = frame.reader:rest()
  if rest then tree:add(F.data, rest) end
  words = words or ("command %02X"):format(command)
  if not ok then
    tree:add_proto_expert_info(E.data, "Bad data: " .. tostring(failure))
    words = words .. " [bad data]"
  end
  if not frame.good then
    words = words .. " [bad checksum]"
  elseif note.role == "request" then
    note.asked = note.asked or { number = pinfo.number, time = pinfo.rel_ts, words = words, elements = elements,
                                 raw = frame.raw }
    if not pinfo.visited and frame.station ~= 0 then pending[key] = note.asked end -- nobody answers a broadcast
    if note.asked.answer then tree:add(F.answer_in, note.asked.answer):set_generated() end
  elseif note.request then
    local seconds = math.floor(note.late)
    tree:add(F.answer_to, note.request.number):set_generated()
    tree:add(F.time, NSTime.new(seconds, math.floor((note.late - seconds) * 1e9 + 0.5))):set_generated()
  elseif note.role == "answer" then
    tree:add_proto_expert_info(E.unasked)
  end
  tree:append_text((": station %d, %s: %s"):format(frame.station, note.role, words))
  local lead = { request = "station %d %s", answer = "station %d answer: %s", echo = "station %d echo: %s" }
  table.insert(context.info, lead[note.role]:format(frame.station, words))
end

local function add_noise(range, tree, context, reason)
  local item = tree:add(F.noise, range)
  item:add_proto_expert_info(E.malformed, reason)
  table.insert(context.info, ("[%d %s: %s]"):format(range:len(), range:len() == 1 and "byte" or "bytes", reason))
end

local function add_checksum(tree, range, got, expected, field, digits)
  local item = got and tree:add(F[field], range, got) or tree:add(range, "A checksum that is no number")
  tree:add(F[field .. "_expected"], range, expected):set_generated()
  tree:add(F.checksum, range, got == expected and 1 or 0):set_generated()
  if got ~= expected then
    local form = "%0" .. digits .. "X"
    local words = "Bad checksum: expected " .. form:format(expected)
    item:add_proto_expert_info(E.checksum, got and words .. ", got " .. form:format(got) or words)
  end
end

-- FACON frames: STX, station, command, data, LRC, ETX -----------------------------------------------------
-- STX begins a frame afresh wherever it is, so that a good frame after a broken one is seen.

local function add_facon_frame(tvb, at, stop, pinfo, tree, context)
  local range = tvb(at, stop - at)
  local text = range:raw()
  local station, command, lrc = text:match("^\2([0-9A-F][0-9A-F])([0-9A-F][0-9A-F]).*(..)\3$")
  if not station or stop - at < 8 or stop - at > 508 then
    add_noise(range, tree, context, "from STX to ETX, but no frame")
    return
  end
  local sum = 0
  for place = at, stop - 4 do sum = (sum + tvb(place, 1):uint()) % 256 end
  local branch = tree:add(range, "FACON")
  local got = lrc:match("^[0-9A-F]+$") and tonumber(lrc, 16)
  local reader = setmetatable({ tvb = tvb, at = at + 5, stop = stop - 3 }, Text)
  dissect_frame({
    tree = branch, reader = reader, raw = range:bytes():tohex(), good = got == sum,
    station = tonumber(station, 16), station_range = tvb(at + 1, 2),
    command = tonumber(command, 16), command_range = tvb(at + 3, 2),
  }, pinfo, context)
  add_checksum(branch, tvb(stop - 3, 2), got, sum, "lrc", 2)
end

-- Gives where a frame begins that has no end yet, or nil.
local function dissect_facon(tvb, pinfo, tree, context)
  local began, free = nil, 0 -- the last STX; the first byte that belongs to nothing yet
  for at = 0, tvb:len() - 1 do
    local byte = tvb(at, 1):uint()
    if byte == 0x02 then
      if began then add_noise(tvb(began, at - began), tree, context, "an incomplete frame, then another beginning")
      elseif at > free then add_noise(tvb(free, at - free), tree, context, "noise outside a frame") end
      began, free = at, at
    elseif byte == 0x03 and began then
      add_facon_frame(tvb, began, at + 1, pinfo, tree, context)
      began, free = nil, at + 1
    end
  end
  if began then return began end
  if free < tvb:len() then add_noise(tvb(free), tree, context, "noise outside a frame") end
  return nil
end

-- M-series frames: 51 or 52, 10, length, payload, CRC, 55 AA ----------------------------------------------
-- Framed by the length: a payload may hold 55 AA.

local xor = bit and bit.bxor or load("return function(a, b) return a ~ b end")()

local function crc16(tvb, at, stop)
  local crc = 0xFFFF
  for place = at, stop - 1 do
    crc = xor(crc, tvb(place, 1):uint())
    for _ = 1, 8 do
      local low = crc % 2
      crc = math.floor(crc / 2)
      if low == 1 then crc = xor(crc, 0xA001) end
    end
  end
  return crc
end

local function is_mseries_head(tvb, at)
  if at + 2 > tvb:len() then return false end
  local head = tvb(at, 2):uint()
  return head == 0x5110 or head == 0x5210
end

-- Gives the end of the frame that begins here, or nil.
local function mseries_end(tvb, at)
  if not is_mseries_head(tvb, at) or at + 10 > tvb:len() then return nil end
  local length = tvb(at + 2, 2):uint()
  local stop = at + 8 + length
  if length < 2 or stop > tvb:len() or tvb(stop - 2, 2):uint() ~= 0x55AA then return nil end
  return stop
end

local function dissect_mseries(tvb, pinfo, tree, context)
  local at, free = 0, 0
  local function noise()
    if at > free then
      local cut = is_mseries_head(tvb, free)
      local reason = cut and "a frame that is cut off or damaged" or "noise outside a frame"
      add_noise(tvb(free, at - free), tree, context, reason)
    end
  end
  while at < tvb:len() do
    local stop = mseries_end(tvb, at)
    if stop then
      noise()
      local branch = tree:add(tvb(at, stop - at), "M-series")
      branch:add(F.length, tvb(at + 2, 2))
      local crc, got = crc16(tvb, at + 2, stop - 4), tvb(stop - 4, 2):le_uint()
      dissect_frame({
        tree = branch, raw = tvb(at, stop - at):bytes():tohex(), good = crc == got,
        reader = setmetatable({ tvb = tvb, at = at + 6, stop = stop - 4 }, Binary),
        station = tvb(at + 4, 1):uint(), station_range = tvb(at + 4, 1),
        command = tvb(at + 5, 1):uint(), command_range = tvb(at + 5, 1),
      }, pinfo, context)
      add_checksum(branch, tvb(stop - 4, 2), got, crc, "crc", 4)
      at, free = stop, stop
    else
      at = at + 1
    end
  end
  noise()
end

-- Captures of fatektool -----------------------------------------------------------------------------------

local MODBUS = { [3] = "mbrtu", [5] = "mbudp" } -- mbudp: the frames of Modbus TCP, without a stream around them

local function dissect_modbus(tvb, pinfo, tree, protocol)
  local found, dissector = pcall(Dissector.get, MODBUS[protocol] or "data-text-lines")
  if not found or not dissector then dissector = Dissector.get("data") end
  dissector:call(tvb, pinfo, tree)
  pinfo.cols.protocol = PROTOCOLS[protocol]
  if protocol == 4 then pinfo.cols.info = tvb():raw():match("^(.-)%s*$"):gsub("[^ -~]", ".") end
end

function fatek.dissector(tvb, pinfo, tree)
  local root = tree:add(fatek, tvb())
  if tvb:len() < 4 then
    root:add_proto_expert_info(E.malformed, "shorter than its pseudo-header")
    return
  end
  local protocol = tvb(2, 1):uint()
  root:add(F.version, tvb(0, 1))
  root:add(F.direction, tvb(1, 1))
  root:add(F.protocol, tvb(2, 1))
  pinfo.cols.protocol = PROTOCOLS[protocol] or "FATEK"
  local sent = tvb(1, 1):uint() == 0
  pinfo.cols.src = sent and "client" or "PLC"
  pinfo.cols.dst = sent and "PLC" or "client"
  if tvb(0, 1):uint() ~= 1 or tvb(1, 1):uint() > 1 or not PROTOCOLS[protocol] then
    root:add_proto_expert_info(E.malformed, "a pseudo-header of another version")
    return
  end
  if tvb:len() == 4 then return end
  local rest = tvb(4):tvb()
  if protocol > 2 then
    dissect_modbus(rest, pinfo, tree, protocol)
    return
  end
  local context = { request = sent, line = "trace", place = 0, info = {} }
  if protocol == 1 then
    local began = dissect_facon(rest, pinfo, root, context)
    if began then add_noise(rest(began), root, context, "a frame that is cut off: no ETX") end
  else
    dissect_mseries(rest, pinfo, root, context)
  end
  pinfo.cols.info = table.concat(context.info, "; ")
end

DissectorTable.get("wtap_encap"):add((wtap_encaps or wtap).USER0, fatek)

-- FACON over TCP and UDP, chosen by Decode As -------------------------------------------------------------

function facon.dissector(tvb, pinfo, tree)
  local root = tree:add(facon, tvb())
  pinfo.cols.protocol = "FACON"
  local asks = pinfo.dst_port < pinfo.src_port -- the PLC's port, 500, is the lower one
  local client = asks and tostring(pinfo.src) .. " " .. pinfo.src_port or tostring(pinfo.dst) .. " " .. pinfo.dst_port
  local context = { request = asks, line = client, place = 0, info = {} }
  local began = dissect_facon(tvb, pinfo, root, context)
  if began and pinfo.can_desegment > 0 and tvb:len() - began < 508 then -- the rest is in the next segment
    pinfo.desegment_offset = began
    pinfo.desegment_len = DESEGMENT_ONE_MORE_SEGMENT
  elseif began then
    add_noise(tvb(began), root, context, "a frame that is cut off: no ETX")
  end
  pinfo.cols.info = table.concat(context.info, "; ")
end

DissectorTable.get("tcp.port"):add_for_decode_as(facon)
DissectorTable.get("udp.port"):add_for_decode_as(facon)
