-- How frames are read. The tables above (boards, records, emcy_fields, ...) say what there is; nothing below
-- lists an object or a bit of a record a second time. What the bus itself tells is learned on the first pass
-- (which board a node is, how its PDOs are mapped, the shift of its accelerations, which object a segment of
-- SDO belongs to) and kept with each frame, so that frames may be looked at in any order.

local kinebus = Proto("kinebus", "Kinebus motion bus (CANopen)")
local can_id, can_extended = Field.new("can.id"), Field.new("can.flags.xtd")
local can_remote = Field.new("can.flags.rtr")

kinebus.prefs.always = Pref.bool("Read all CAN frames as Kinebus", false,
  "Otherwise choose Kinebus by Decode As, or -d can.subdissector,kinebus")
for i = 2, #boards do
  kinebus.prefs[boards[i].name] = Pref.string("Nodes of board " .. boards[i].name, "",
    "Node ids with commas, for captures in which the nodes do not say what they are")
end

local malformed = ProtoExpert.new("kinebus.malformed", "Malformed frame", expert.group.MALFORMED,
  expert.severity.ERROR)
local wrong_check = ProtoExpert.new("kinebus.wrong_check", "Check bits are wrong: nodes do not obey",
  expert.group.CHECKSUM, expert.severity.WARN)
local unknown = ProtoExpert.new("kinebus.unknown", "Not known to Kinebus", expert.group.UNDECODED,
  expert.severity.WARN)
local refused = ProtoExpert.new("kinebus.refused", "SDO abort", expert.group.RESPONSE_CODE, expert.severity.NOTE)
local emergency = ProtoExpert.new("kinebus.emergency", "Emergency", expert.group.RESPONSE_CODE,
  expert.severity.WARN)
kinebus.experts = {malformed, wrong_check, unknown, refused, emergency}

-- Fields of the dissector, for filters. Values are those of the unit that is shown.
local proto_fields, taken = {}, {}
local function new_field(make, abbreviation, label, ...)
  local field = make("kinebus." .. abbreviation, label, ...)
  proto_fields[#proto_fields + 1] = field
  taken[abbreviation] = true
  return field
end
local function number_field(abbreviation, label, bits, signed, factor)
  if factor ~= 1 or bits > 32 then return new_field(ProtoField.double, abbreviation, label) end
  return new_field(signed and ProtoField.int32 or ProtoField.uint32, abbreviation, label)
end

local f_node = new_field(ProtoField.uint8, "node", "Node id")
local f_service = new_field(ProtoField.string, "service", "Service")
local f_sync = new_field(ProtoField.uint8, "sync.counter", "SYNC counter")
local f_time_ms = new_field(ProtoField.uint32, "time.ms", "Milliseconds since midnight (ms)")
local f_time_days = new_field(ProtoField.uint16, "time.days", "Days since 1984-01-01 (d)")
local f_sdo_command = new_field(ProtoField.uint8, "sdo.command", "Command", base.HEX)
local f_sdo_index = new_field(ProtoField.uint16, "sdo.index", "Index", base.HEX)
local f_sdo_subindex = new_field(ProtoField.uint8, "sdo.subindex", "Subindex")
local f_sdo_object = new_field(ProtoField.string, "sdo.object", "Object")
local f_sdo_abort = new_field(ProtoField.uint32, "sdo.abort", "Abort code", base.HEX)
local f_sdo_size = new_field(ProtoField.uint32, "sdo.size", "Size (bytes)")
local f_sdo_sequence = new_field(ProtoField.uint8, "sdo.sequence", "Segment of its block")
local f_sdo_block = new_field(ProtoField.uint8, "sdo.block_size", "Segments a block")
local f_sdo_crc = new_field(ProtoField.uint16, "sdo.crc", "CRC of the data", base.HEX)
local f_sdo_switch = new_field(ProtoField.uint8, "sdo.switch", "Protocol switch threshold (bytes)")
local f_sdo_data = new_field(ProtoField.bytes, "sdo.data", "Data of a segment")
local f_sdo_unused = new_field(ProtoField.bytes, "sdo.unused", "Not used")
local f_text = new_field(ProtoField.string, "text", "Text")
local f_emcy_vendor = new_field(ProtoField.bytes, "emcy.vendor", "Manufacturer's data")
local f_emcy_rpdo = new_field(ProtoField.uint8, "emcy.rpdo", "RPDO that is concerned")
local f_emcy_heaters = new_field(ProtoField.uint8, "emcy.heaters", "Heaters concerned (bit 0: heater 1)", base.HEX)
local f_emcy_sensors = new_field(ProtoField.uint8, "emcy.sensors", "Sensors concerned (bit 0: sensor 1)", base.HEX)
local f_emcy_fans = new_field(ProtoField.uint8, "emcy.fans", "Fans concerned (bit 0: fan 1)", base.HEX)
local f_rest = new_field(ProtoField.bytes, "rest", "Bytes that nothing is known of")

local function label_of(row)
  return row.unit ~= "" and row.name .. " (" .. row.unit .. ")" or row.name
end
local function add_fields(group, rows)
  for _, row in ipairs(rows) do
    row.field = number_field(group .. "." .. row.key, label_of(row), row.bits, row.signed, row.factor)
  end
end
for _, record in pairs(records) do add_fields(record.key, record.fields) end
add_fields("emcy", emcy_fields)
add_fields("nmt", nmt_fields)
add_fields("heartbeat", heartbeat_fields)
add_fields("lss", lss_fields)
add_fields("voucher", voucher_fields)

local type_bits = {bool = 8, i8 = 8, u8 = 8, i16 = 16, u16 = 16, i32 = 32, u32 = 32, i64 = 64, u64 = 64}
for place, board in ipairs(boards) do
  for key, row in pairs(board.objects) do
    local object = {key = key, name = row[2], unit = row[4], factor = row[5], type = row[3]}
    if row[1] ~= row[2] then object.name = row[1] .. ": " .. row[2] end
    if row[6] >= 0 then object.name = object.name .. (row[6] == 0 and " A" or " B") end
    object.axis = row[6]
    object.base = row[6] == 1 and key - 0x80000 or key
    object.bits = type_bits[object.type] or 0
    object.signed = object.type:sub(1, 1) == "i"
    -- What boards have in common is one field; where they differ, the later board's carries its name.
    local abbreviation = string.format("object.%04x.%d", math.floor(key / 256), key % 256)
    for earlier = 1, place - 1 do
      local other = boards[earlier].objects[key]
      if other then
        if other.name == object.name and other.type == object.type and other.unit == object.unit then
          object.field = other.field
        else
          abbreviation = abbreviation .. "." .. board.name
        end
      end
    end
    if not object.field and not taken[abbreviation] then
      if object.bits == 0 then
        object.field = new_field(ProtoField.string, abbreviation, object.name)
      else
        object.field = number_field(abbreviation, label_of(object), object.bits, object.signed, object.factor)
      end
    end
    board.objects[key] = object
  end
end
kinebus.fields = proto_fields

-- Numbers ------------------------------------------------------------------------------------------------------

local function bytes_of(tvb)
  local bytes = {}
  for i = 0, math.min(tvb:len(), 8) - 1 do bytes[i] = tvb(i, 1):uint() end
  bytes.length = tvb:len()
  return bytes
end
local function word(bytes, at, count)
  local value = 0
  for i = count - 1, 0, -1 do value = value * 256 + (bytes[at + i] or 0) end
  return value
end
-- Bits `start` on of up to 8 bytes, least significant first. Exact up to 53 bits, and beyond as a double is.
local function bits_of(bytes, start, bits, signed)
  local first, last = math.floor(start / 8), math.floor((start + bits - 1) / 8)
  local below, value, weight = start % 8, 0, 1
  for i = first, last do
    local byte, count = bytes[i] or 0, 8
    if i == first then byte, count = math.floor(byte / 2 ^ below), 8 - below end
    if i == last then
      local over = (last + 1) * 8 - (start + bits)
      byte, count = byte % 2 ^ (count - over), count - over
      if signed and byte >= 2 ^ (count - 1) then byte = byte - 2 ^ count end
    end
    value, weight = value + byte * weight, weight * 2 ^ count
  end
  return math.floor(value)
end
local function number_text(value)
  if value == math.floor(value) and math.abs(value) < 2 ^ 53 then return string.format("%.0f", value) end
  return string.format("%.9g", value)
end
local function bit_at(bytes, bit)
  return math.floor((bytes[math.floor(bit / 8)] or 0) / 2 ^ (bit % 8)) % 2
end

-- Check bits, as the nodes calculate them. The bits from `held_from` on are the check itself and count as 0.
local function check_bits(bytes, width, polynomial, held_from, held_bits)
  local rest = {}
  for i = 0, width - 1 do rest[i] = 1 end
  for bit = 63, 0, -1 do
    local one = bit_at(bytes, bit)
    if bit >= held_from and bit < held_from + held_bits then one = 0 end
    local out = rest[width - 1] ~= one
    for i = width - 1, 0, -1 do
      local below = i > 0 and rest[i - 1] or 0
      if out and math.floor(polynomial / 2 ^ i) % 2 == 1 then below = 1 - below end
      rest[i] = below
    end
  end
  local value = 0
  for i = 0, width - 1 do value = value + rest[i] * 2 ^ i end
  return value
end
local function control_check(bytes)
  local rest = 0
  for bit = 60, 0, -1 do
    rest = rest * 2 + bit_at(bytes, bit)
    if rest >= 8 then
      rest = rest - 8                       -- x^3 + x + 1: bits 0 and 1 change
      rest = rest - rest % 4 + 3 - rest % 4
    end
  end
  return 7 - rest
end

-- What the bus has told -----------------------------------------------------------------------------------------

local nodes, owners, transfers, frames, preferred = {}, {}, {}, {}, {}

local function read_preferences()
  preferred = {}
  for i = 2, #boards do
    for id in tostring(kinebus.prefs[boards[i].name] or ""):gmatch("%d+") do preferred[tonumber(id)] = boards[i] end
  end
end
function kinebus.prefs_changed() read_preferences() end
function kinebus.init()
  nodes, owners, transfers, frames = {}, {}, {}, {}
  read_preferences()
end

-- A node is never changed, but replaced: frames keep what was true when they came.
local function node_of(id)
  local node = nodes[id]
  if not node then
    node = {id = id, board = preferred[id], maps = {}, shift = {[0] = 2, [1] = 2}}
    nodes[id] = node
  end
  return node
end
local function change(id, what, value)
  local copy = {}
  for k, v in pairs(node_of(id)) do copy[k] = v end
  copy[what] = value
  nodes[id] = copy
end
local function board_of(node) return node.board or boards[1] end
local function object_of(node, key)
  return board_of(node).objects[key] or other_objects[key]
end

local function default_map(node, direction, number)
  local pdos = direction == "T" and board_of(node).tpdos or board_of(node).rpdos
  local pdo = pdos[number]
  return pdo and pdo.map, pdo and pdo.name
end

local function learn(id, key, value)
  local node, index, sub = node_of(id), math.floor(key / 256), key % 256
  if key == 0x101802 then
    for _, board in ipairs(boards) do
      if board.product == value then change(id, "board", board) end
    end
  elseif (index == 0x2140 or index == 0x2940) and sub == 1 and value <= 7 then
    local shift = {[0] = node.shift[0], [1] = node.shift[1]}
    shift[index == 0x2940 and 1 or 0] = value
    change(id, "shift", shift)
  elseif (index >= 0x1400 and index < 0x1600 or index >= 0x1800 and index < 0x1A00) and sub == 1 then
    local direction = index < 0x1800 and "R" or "T"
    local number = index % 0x200 + 1
    for cob, owner in pairs(owners) do
      if owner.id == id and owner.direction == direction and owner.number == number then owners[cob] = nil end
    end
    owners[value % 0x800] = {id = id, direction = direction, number = number}
  elseif (index >= 0x1600 and index < 0x1800 or index >= 0x1A00 and index < 0x1C00) and sub <= 8 then
    local direction, number = index < 0x1800 and "R" or "T", index % 0x200 + 1
    local name = direction .. number
    local old = node.maps[name] or {rows = default_map(node, direction, number) or {}}
    local map, maps = {rows = {}, count = old.count}, {}
    for i = 1, 8 do map.rows[i] = old.rows[i] end
    if sub == 0 then map.count = value else map.rows[sub] = value end
    for k, v in pairs(node.maps) do maps[k] = v end
    maps[name] = map
    change(id, "maps", maps)
  end
end

local function pdo_in(id, length)
  local owner = owners[id]
  if not owner and broadcasts[id] then return {broadcast = broadcasts[id], map = broadcasts[id].map} end
  if not owner then
    local code, node = math.floor(id / 128), id % 128
    if code < 3 or code > 10 or node == 0 then return nil end
    owner = {id = node, direction = code % 2 == 1 and "T" or "R", number = math.floor((code - 1) / 2)}
  end
  local node = node_of(owner.id)
  if not node.board then  -- its length may tell the board
    local fits, count = nil, 0
    for _, board in ipairs(boards) do
      local pdo = (owner.direction == "T" and board.tpdos or board.rpdos)[owner.number]
      if pdo and pdo.bits == length * 8 then fits, count = board, count + 1 end
    end
    if count == 1 then change(owner.id, "board", fits) end
    node = node_of(owner.id)
  end
  local rows, name = default_map(node, owner.direction, owner.number)
  local learned = node.maps[owner.direction .. owner.number]
  if learned then
    rows = {}
    for i = 1, learned.count or 8 do
      if not learned.rows[i] then break end
      rows[i] = learned.rows[i]
    end
  end
  return {owner = owner, node = node, map = rows or {}, name = name}
end

-- One frame of SDO: what it is, by what came before. `client`: it goes to the node.
local function sdo_step(id, bytes, client)
  local transfer = transfers[id]
  local command, key = bytes[0], word(bytes, 1, 2) * 256 + bytes[3]
  local specifier = math.floor(command / 32)
  local function ended() transfers[id] = nil end

  if command == 0x80 then
    ended()
    return {title = "abort", key = key, abort = word(bytes, 4, 4)}
  end
  if transfer and transfer.block_from == (client and "client" or "server") then
    local sequence, last = command % 128, command >= 128
    if last or sequence == transfer.block_size then transfer.block_from = nil end
    transfer.last = last and sequence or nil
    return {title = (client and "block download segment " or "block upload segment ") .. sequence .. (last and ", last" or ""),
      of = transfer.key, sequence = sequence, data_at = 1, data = 7}
  end

  local expedited, sized = math.floor(command / 2) % 2 == 1, command % 2 == 1
  local function initiated(title)
    local step = {title = title, key = key}
    if expedited then
      step.value = sized and 4 - math.floor(command / 4) % 4 or 4
      if not sized then step.unsized = true end
    elseif sized then
      step.size = word(bytes, 4, 4)
    else
      step.unused_at = 4
    end
    return step
  end
  local function segment(title)
    local count, last = 7 - math.floor(command / 2) % 8, command % 2 == 1
    local step = {title = title .. (last and " segment, last" or " segment"), of = transfer and transfer.key,
      data_at = 1, data = count, unused_at = 1 + count}
    if transfer then
      for i = 1, count do
        if #transfer.bytes < 256 then transfer.bytes[#transfer.bytes + 1] = bytes[i] end
      end
      if last then step.whole = transfer.bytes end
    end
    return step, last
  end

  -- Segments were received up to the one that is named; unless that was the last, more of them come.
  local function next_block(from)
    if transfer and transfer.last ~= bytes[1] then transfer.block_size, transfer.block_from = bytes[2], from end
  end

  if client then
    if specifier == 1 then
      transfers[id] = {key = key, bytes = {}, pending = expedited and word(bytes, 4, 4) or nil}
      return initiated("write")
    elseif specifier == 0 then
      return (segment("write"))
    elseif specifier == 2 then
      transfers[id] = {key = key, bytes = {}}
      return {title = "read", key = key, unused_at = 4}
    elseif specifier == 3 then
      return {title = "next segment, please", of = transfer and transfer.key, unused_at = 1}
    elseif specifier == 6 then
      if command % 2 == 0 then
        transfers[id] = {key = key, bytes = {}}
        local step = {title = "block download", key = key}
        if expedited then step.size = word(bytes, 4, 4) else step.unused_at = 4 end
        return step
      end
      return {title = "block download ends", of = transfer and transfer.key, crc_at = 1, unused_at = 3}
    elseif specifier == 5 then
      local part = command % 4
      if part == 0 then
        transfers[id] = {key = key, bytes = {}, block_size = bytes[4]}
        return {title = "block upload", key = key, block_at = 4, switch_at = 5, unused_at = 6}
      elseif part == 1 then
        ended()
        return {title = "block upload has ended", of = transfer and transfer.key, unused_at = 1}
      elseif part == 2 then
        next_block("server")
        return {title = "block upload segments received", of = transfer and transfer.key, sequence_at = 1, block_at = 2,
          unused_at = 3}
      end
      if transfer then transfer.block_from = "server" end
      return {title = "block upload, please", of = transfer and transfer.key, unused_at = 1}
    end
  else
    if specifier == 3 then
      if transfer and transfer.key == key and transfer.pending then
        learn(id, key, transfer.pending)
        ended()
      end
      return {title = "written", key = key, unused_at = 4}
    elseif specifier == 1 then
      return {title = "segment written", of = transfer and transfer.key, unused_at = 1}
    elseif specifier == 2 then
      local step = initiated("is")
      if step.value then
        learn(id, key, word(bytes, 4, step.value))
        ended()
      end
      return step
    elseif specifier == 0 then
      local step, last = segment("read")
      if last then ended() end
      return step
    elseif specifier == 5 then
      local part = command % 4
      if part == 0 then
        if transfer then transfer.block_size, transfer.block_from = bytes[4], "client" end
        return {title = "block download accepted", key = key, block_at = 4, unused_at = 5}
      elseif part == 2 then
        next_block("client")
        return {title = "block download segments received", of = transfer and transfer.key, sequence_at = 1,
          block_at = 2, unused_at = 3}
      end
      ended()
      return {title = "block download has ended", of = transfer and transfer.key, unused_at = 1}
    elseif specifier == 6 then
      if command % 2 == 1 then
        return {title = "block upload ends", of = transfer and transfer.key, crc_at = 1, unused_at = 3}
      end
      local step = {title = "block upload accepted", key = key}
      if expedited then step.size = word(bytes, 4, 4) else step.unused_at = 4 end
      return step
    end
  end
  return {title = "command " .. string.format("%02Xh", command), malformed = "no command specifier of CiA 301"}
end

-- Showing -------------------------------------------------------------------------------------------------------

local function range(tvb, start, bits)
  local first = math.floor(start / 8)
  return tvb(first, math.floor((start + bits - 1) / 8) - first + 1)
end
local function with_unit(text, unit) return unit ~= "" and text .. " " .. unit or text end

-- Adds the fields of a record that begin at bit `at`; returns their raw values by key, and a line of them. `tvb`
-- is nil for what was put together from several frames.
local function show_fields(tree, tvb, bytes, rows, at, shift)
  local raw, words = {}, {}
  for _, row in ipairs(rows) do
    local there = true
    if row.selector then
      local value = raw[row.selector]
      there = value ~= nil and value >= row.low and value <= row.high
    end
    if there and (not tvb or tvb:len() * 8 >= at + row.start + row.bits) then
      local value = bits_of(bytes, at + row.start, row.bits, row.signed)
      raw[row.key] = value
      local factor = row.factor
      if row.shifted and shift then factor = factor * 2 ^ (shift[row.shifted] - 2) end
      local shown = value * factor
      local text = with_unit(number_text(shown), row.unit)
      if row.values and row.values[value] then text = row.values[value] .. " (" .. text .. ")" end
      local item
      if tvb then item = tree:add(row.field, range(tvb, at + row.start, row.bits), shown)
      else item = tree:add(row.field, shown):set_generated() end
      item:set_text(row.name .. ": " .. text)
      words[#words + 1] = row.name .. " " .. (row.values and row.values[value] or text)
    end
  end
  return raw, words
end

local function flags_of(value, names)
  local set = {}
  for bit, name in pairs(names) do
    if math.floor(value / 2 ^ bit) % 2 == 1 then set[#set + 1] = {bit, name} end
  end
  table.sort(set, function(a, b) return a[1] < b[1] end)
  for i, flag in ipairs(set) do set[i] = flag[2] end
  return table.concat(set, ", ")
end
local register_bits = {[0] = "generic", "current", "voltage", "temperature", "communication", "device profile",
  [7] = "manufacturer"}
local status_bits = {[7] = "warning", [9] = "remote", [10] = "target reached", [11] = "internal limit",
  [12] = "mode's bit 12", [13] = "mode's bit 13", [14] = "mode's bit 14"}

local function object_text(object, value)
  local text = with_unit(number_text(value * object.factor), object.unit)
  if object.bits == 0 then return text end
  if object.base == 0x604100 then
    local flags = flags_of(value, status_bits)
    return string.format("%04Xh %s%s", value, status_states[value % 128] or "no state of CiA 402",
      flags ~= "" and ", " .. flags or "")
  end
  if mode_objects[object.base] and mode_names[value] then return mode_names[value] .. " (" .. text .. ")" end
  if object.unit == "" and not object.signed and object.bits >= 16 and object.bits <= 32 then
    return string.format("%s (%0" .. object.bits / 4 .. "Xh)", text, value)
  end
  return text
end
local function object_name(node, key)
  local object = object_of(node, key)
  local place = string.format("%04Xh:%d", math.floor(key / 256), key % 256)
  return object and place .. " " .. object.name or place, object
end

-- The value of an object at `at` of the frame; `count` bytes. Returns it as text.
local function show_value(tree, tvb, bytes, object, at, count)
  if object.bits == 0 then
    local text = tvb(at, count):string()
    tree:add(object.field or f_text, tvb(at, count), text)
    return text
  end
  local value = bits_of(bytes, at * 8, math.min(count * 8, object.bits), object.signed)
  local text = object_text(object, value)
  local item = tree:add(object.field, tvb(at, count), value * object.factor)
  item:set_text(object.name .. ": " .. text)
  if count * 8 ~= object.bits then
    item:add_proto_expert_info(malformed, string.format("%d bytes where the object has %d", count, object.bits / 8))
  end
  return text
end

local record_checks = {
  segment = function(raw, bytes, item)
    if raw.duration ~= 0 then return end
    if raw.control ~= 1 and raw.control ~= 2 then
      item:add_proto_expert_info(malformed, "A control record that is neither start nor end")
    end
    if raw.recordcheck ~= control_check(bytes) then item:add_proto_expert_info(wrong_check) end
  end,
  rate = function(raw, bytes, item)
    if raw.kind < 1 or raw.kind > 4 or raw.rate > 32768 or raw.fullramp == 0 then
      item:add_proto_expert_info(malformed, "Kind, rate or ramp is out of its range")
    end
    if raw.check ~= check_bits(bytes, 8, 0x2F, 56, 8) then item:add_proto_expert_info(wrong_check) end
  end,
  stamp = function(raw, bytes, item)
    if raw.counter == 0 or raw.counter > 240 or raw.nanoseconds > 999 then
      item:add_proto_expert_info(malformed, "Counter or nanoseconds are out of their range")
    end
    if raw.check ~= check_bits(bytes, 6, 0x03, 26, 6) then item:add_proto_expert_info(wrong_check) end
  end,
}

local function show_pdo(tree, tvb, bytes, context)
  local at, words = 0, {}
  local node = context.node or {id = 127, shift = {[0] = 2, [1] = 2}}
  for _, mapping in ipairs(context.map) do
    local bits, key = mapping % 256, math.floor(mapping / 256)
    if at + bits > tvb:len() * 8 then
      tree:add_proto_expert_info(malformed, string.format("Shorter than its mapping: no %s",
        (object_name(node, key))))
      break
    end
    local name, object = object_name(node, key)
    local record = records[key]
    if record and bits == 64 then
      local item = tree:add(range(tvb, at, bits), record.name)
      local raw, said = show_fields(item, tvb, bytes, record.fields, at, node.shift)
      if record_checks[record.key] then record_checks[record.key](raw, bytes, item) end
      words[#words + 1] = table.concat(said, ", ")
    elseif key < 0x2000 and at % 8 == 0 then
      words[#words + 1] = "filler"
      tree:add(f_sdo_unused, range(tvb, at, bits))
    elseif object and object.bits > 0 and at % 8 == 0 and bits % 8 == 0 then
      words[#words + 1] = object.name .. " " .. show_value(tree, tvb, bytes, object, at / 8, bits / 8)
    else
      tree:add(f_rest, range(tvb, at, bits)):add_proto_expert_info(unknown, name .. " is in no object table")
    end
    at = at + bits
  end
  local used = math.ceil(at / 8)
  if #context.map == 0 then
    tree:add_proto_expert_info(unknown, "Nothing is mapped into this PDO")
  end
  if used < tvb:len() then
    local item = tree:add(f_rest, tvb(used))
    if #context.map > 0 then item:add_proto_expert_info(malformed, "Longer than its mapping") end
  end
  return table.concat(words, "; ")
end

local function show_sdo(tree, tvb, bytes, context)
  local step, node = context.step, context.node
  tree:add(f_sdo_command, tvb(0, 1)):append_text(" (" .. step.title .. ")")
  local text = step.title
  local key = step.key or step.of
  local name, object = nil, nil
  if key then
    name, object = object_name(node, key)
    if step.key then
      tree:add_le(f_sdo_index, tvb(1, 2))
      tree:add(f_sdo_subindex, tvb(3, 1))
      tree:add(f_sdo_object, tvb(1, 3), name)
    else
      tree:add(f_sdo_object, name):set_generated()
    end
    text = step.title .. " " .. name
    if step.title == "is" then text = name end
  end
  if step.abort then
    local words = abort_codes[step.abort] or "unknown abort code"
    tree:add_le(f_sdo_abort, tvb(4, 4)):append_text(" (" .. words .. ")")
    tree:add_proto_expert_info(refused, words)
    return text .. string.format(": %08Xh %s", step.abort, words)
  end
  if step.value then
    local count = step.value
    if step.unsized and object and object.bits > 0 then count = math.min(4, object.bits / 8) end
    if object then
      text = text .. " = " .. show_value(tree, tvb, bytes, object, 4, count)
    else
      tree:add(f_sdo_data, tvb(4, count))
      tree:add_proto_expert_info(unknown, name .. " is in no object table")
    end
    if count < 4 then tree:add(f_sdo_unused, tvb(4 + count)) end
  end
  if step.size then tree:add_le(f_sdo_size, tvb(4, 4)) end
  if step.sequence then tree:add(f_sdo_sequence, tvb(0, 1), step.sequence) end
  if step.sequence_at then tree:add(f_sdo_sequence, tvb(step.sequence_at, 1)) end
  if step.block_at then tree:add(f_sdo_block, tvb(step.block_at, 1)) end
  if step.switch_at then tree:add(f_sdo_switch, tvb(step.switch_at, 1)) end
  if step.crc_at then tree:add_le(f_sdo_crc, tvb(step.crc_at, 2)) end
  if step.data and step.data > 0 then tree:add(f_sdo_data, tvb(step.data_at, step.data)) end
  if step.unused_at and step.unused_at < 8 then tree:add(f_sdo_unused, tvb(step.unused_at)) end
  if step.whole and object then
    local whole
    if object.bits == 0 then
      local letters = {}
      for i, byte in ipairs(step.whole) do letters[i] = byte >= 32 and byte < 127 and string.char(byte) or "?" end
      whole = table.concat(letters)
      tree:add(object.field or f_text, whole):set_generated()
    else
      local value_bytes = {}
      for i, byte in ipairs(step.whole) do value_bytes[i - 1] = byte end
      if records[key] and #step.whole == 8 then
        local _, said = show_fields(tree, nil, value_bytes, records[key].fields, 0, node.shift)
        whole = table.concat(said, ", ")
      else
        local value = bits_of(value_bytes, 0, object.bits, object.signed)
        whole = object_text(object, value)
        local item = tree:add(object.field, value * object.factor):set_generated()
        item:set_text(object.name .. ": " .. whole)
      end
    end
    text = text .. " = " .. whole
  end
  if step.malformed then tree:add_proto_expert_info(malformed, step.malformed) end
  return text
end

local function show_emcy(tree, tvb, bytes, context)
  local raw = show_fields(tree, tvb, bytes, {emcy_fields[1], emcy_fields[2]}, 0)
  local alarm = alarms[raw.errorcode] or alarm_classes[math.floor(raw.errorcode / 4096)]
  local text = string.format("%04Xh %s", raw.errorcode, raw.errorcode == 0 and "no error" or alarm or "unknown fault")
  local flags = flags_of(raw.errorregister, register_bits)
  if flags ~= "" then text = text .. " (" .. flags .. ")" end
  local reason = bytes[3] % 128
  if reason ~= 0 then
    show_fields(tree, tvb, bytes, {emcy_fields[3], emcy_fields[4], emcy_fields[5], emcy_fields[6]}, 0)
    local words = stop_reasons[reason] or "unknown reason"
    text = text .. ": all stop, " .. words
    -- The check is over the reason and the time alone.
    if check_bits({[0] = bytes[3], bytes[4], bytes[5], bytes[6]}, 8, 0x2F, 64, 0) ~= bytes[7] then
      tree:add_proto_expert_info(wrong_check, "Check bits are wrong: no node stops for this")
    end
  elseif math.floor(raw.errorcode / 256) == 0x82 then
    tree:add(f_emcy_rpdo, tvb(4, 1))
    tree:add(f_emcy_vendor, tvb(5, 3))
  elseif board_of(context.node).profile == 404 then
    tree:add(f_emcy_heaters, tvb(4, 1))
    tree:add(f_emcy_sensors, tvb(5, 1))
    tree:add(f_emcy_fans, tvb(6, 1))
    tree:add(f_emcy_vendor, tvb(7, 1))
  else
    tree:add(f_emcy_vendor, tvb(3, 5))
  end
  if raw.errorcode ~= 0 then tree:add_proto_expert_info(emergency, text) end
  return text
end

-- Services ------------------------------------------------------------------------------------------------------

local function name_of(id) return id == 127 and "Gateway" or "Node " .. id end

-- {service, node, sender, exact length, show}; learning is done here, once a frame.
local function frame_of(id, bytes)
  local node = id % 128
  if id == 0x000 then return {service = "NMT", length = 2, kind = "nmt", sender = "Gateway"} end
  if id == 0x080 then return {service = "SYNC", kind = "sync", sender = "Gateway"} end
  if id == 0x100 then return {service = "TIME", length = 6, kind = "time", sender = "Gateway"} end
  if id == voucher_id then return {service = "Voucher", length = 8, kind = "voucher", sender = "Gateway"} end
  if id == 0x7E4 then return {service = "LSS reply", length = 8, kind = "lss", sender = "Node"} end
  if id == 0x7E5 then return {service = "LSS request", length = 8, kind = "lss", sender = "Gateway"} end
  if id > 0x080 and id < 0x100 then
    return {service = "EMCY", length = 8, kind = "emcy", id = node, node = node_of(node), sender = name_of(node)}
  end
  if id > 0x700 and id < 0x780 then
    return {service = "Heartbeat", length = 1, kind = "heartbeat", id = node, sender = name_of(node)}
  end
  if (id > 0x580 and id < 0x600) or (id > 0x600 and id < 0x680) then
    local client = id > 0x600
    local frame = {service = client and "SDO request" or "SDO reply", length = 8, kind = "sdo", id = node,
      sender = client and "Gateway" or name_of(node), receiver = client and name_of(node) or nil}
    if bytes.length == 8 then frame.step = sdo_step(node, bytes, client) end
    frame.node = node_of(node)
    return frame
  end
  local pdo = pdo_in(id, bytes.length)
  if not pdo then return {service = string.format("Identifier %03Xh", id), kind = "unknown", sender = "?"} end
  if pdo.broadcast then
    return {service = pdo.broadcast.name, kind = "pdo", map = pdo.map, sender = "Gateway"}
  end
  local receives = pdo.owner.direction == "R"
  return {service = string.format("%sPDO%d %s", pdo.owner.direction, pdo.owner.number, pdo.name or ""), kind = "pdo",
    map = pdo.map, node = pdo.node, id = pdo.owner.id, sender = receives and "Gateway" or name_of(pdo.owner.id),
    receiver = receives and name_of(pdo.owner.id) or nil}
end

local show = {
  nmt = function(tree, tvb, bytes)
    local raw, words = show_fields(tree, tvb, bytes, nmt_fields, 0)
    if not nmt_fields[1].values[raw.command] or raw.node > 127 then
      tree:add_proto_expert_info(malformed, "No such command, or no such node")
    end
    return table.concat(words, ", ")
  end,
  sync = function(tree, tvb)
    if tvb:len() > 1 then
      tree:add_proto_expert_info(malformed, "SYNC has a counter or nothing")
      tree:add(f_rest, tvb())
      return ""
    end
    if tvb:len() == 0 then return "without counter" end
    tree:add(f_sync, tvb(0, 1))
    return tostring(tvb(0, 1):uint())
  end,
  time = function(tree, tvb, bytes)
    tree:add(f_time_ms, tvb(0, 4), bits_of(bytes, 0, 28, false))
    tree:add(f_time_days, tvb(4, 2), word(bytes, 4, 2))
    return bits_of(bytes, 0, 28, false) .. " ms, day " .. word(bytes, 4, 2)
  end,
  heartbeat = function(tree, tvb, bytes)
    local raw, words = show_fields(tree, tvb, bytes, heartbeat_fields, 0)
    if not heartbeat_fields[1].values[raw.nmtstate] then
      tree:add_proto_expert_info(malformed, "No such NMT state")
    end
    return words[1]
  end,
  voucher = function(tree, tvb, bytes)
    local raw = show_fields(tree, tvb, bytes, voucher_fields, 0)
    return "for the next frame, number .." .. string.format("%04Xh", raw.number)
  end,
  lss = function(tree, tvb, bytes)
    local raw, words = show_fields(tree, tvb, bytes, {lss_fields[1], lss_fields[2]}, 0)
    local command = lss_fields[1].values[raw.command]
    if command == "fastscan" then
      show_fields(tree, tvb, bytes, {lss_fields[3], lss_fields[4], lss_fields[5]}, 0)
    else
      tree:add(f_sdo_unused, tvb(5, 3))
      if not command then tree:add_proto_expert_info(malformed, "No such service of LSS") end
    end
    return table.concat(words, ", ")
  end,
  emcy = show_emcy,
  pdo = show_pdo,
  sdo = show_sdo,
  unknown = function(tree, tvb)
    tree:add_proto_expert_info(unknown, "No identifier of Kinebus's connection set")
    if tvb:len() > 0 then tree:add(f_rest, tvb()) end
    return ""
  end,
}

local function last_of(field)
  local all = {field()}
  return #all > 0 and all[#all].value or nil
end

function kinebus.dissector(tvb, pinfo, root)
  local id = last_of(can_id)
  if id == nil then return 0 end
  pinfo.cols.protocol = "KINEBUS"
  local consumed = math.max(tvb:len(), 1)
  local tree = tvb:len() > 0 and root:add(kinebus, tvb()) or root:add(kinebus)
  local function head(frame, text)
    local line = frame.sender .. (frame.receiver and " to " .. frame.receiver or "") .. ": " .. frame.service
    if text ~= "" then line = line .. " " .. text end
    tree:add(f_service, frame.service):set_generated()
    if frame.id then tree:add(f_node, frame.id):set_generated() end
    tree:set_text("Kinebus, " .. line)
    pinfo.cols.info = line
  end
  if last_of(can_extended) then
    head({service = string.format("Extended identifier %08Xh", id), sender = "?"}, "")
    tree:add_proto_expert_info(unknown, "Kinebus has no extended identifiers")
    if tvb:len() > 0 then tree:add(f_rest, tvb()) end
    return consumed
  end
  local bytes = bytes_of(tvb)
  if last_of(can_remote) then
    local target = id > 0x700 and id < 0x780 and name_of(id % 128) or string.format("%03Xh", id)
    head({service = "Remote request", sender = "?"}, "for " .. target)
    tree:add_proto_expert_info(unknown, "Nothing in Kinebus answers remote requests")
    return consumed
  end

  local frame = frames[pinfo.number]
  if not frame or not pinfo.visited then
    frame = frame_of(id, bytes)
    frames[pinfo.number] = frame
  end
  if tvb:len() > 8 or (frame.length and tvb:len() ~= frame.length) then
    head(frame, "malformed")
    tree:add_proto_expert_info(malformed, string.format("%s has %d bytes, not %d", frame.service, tvb:len(),
      frame.length or 8))
    if tvb:len() > 0 then tree:add(f_rest, tvb()) end
    return consumed
  end
  head(frame, show[frame.kind](tree, tvb, bytes, frame))
  return consumed
end

DissectorTable.get("can.subdissector"):add_for_decode_as(kinebus)
kinebus:register_heuristic("can", function(tvb, pinfo, root)
  if not kinebus.prefs.always then return false end
  kinebus.dissector(tvb, pinfo, root)
  return true
end)
