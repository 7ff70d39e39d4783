#include "protocol/canopen/pdo_engine.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/emcy.hpp"

namespace kinebus {
namespace {

constexpr std::uint32_t kOff = 0x8000'0000, kNoRtr = 0x4000'0000, kExtended = 0x2000'0000, kIdBits = 0x7FF;
// Of a PDO that this node's table does not have: a COB-ID that is off, and a type that is none.
constexpr std::int64_t kNoSuchPdo = -1;
constexpr std::uint32_t kUnusedIdBits = 0x1FFF'F800;

bool valid_type(std::int64_t type) {
  return (type >= 0 && type <= 240) || type == 254 || type == 255;
}
bool synchronous(std::uint8_t type) {
  return type <= 240;
}
LocalTime hundreds_of_us(std::int64_t value) {
  return LocalTime{value * 100'000};
}
LocalTime milliseconds_of(std::int64_t value) {
  return LocalTime{value * 1'000'000};
}

}  // namespace

std::int64_t PdoEngine::parameter(std::uint16_t index, std::uint8_t subindex) const {
  const int place = objects_.place_of({index, subindex});
  return place < 0 ? kNoSuchPdo : objects_.value(objects_.table()[place].value_slot());
}

PdoEngine::Pdo* PdoEngine::pdo_of(ObjectAddress address) {
  const auto number = static_cast<std::size_t>(address.index & 0x1FF);
  if (is_tpdo(address)) return number < tpdos_.size() ? &tpdos_[number] : nullptr;
  return number < rpdos_.size() ? &rpdos_[number] : nullptr;
}

void PdoEngine::configure() {
  for (std::uint16_t i = 0; i < kRpdoCount; ++i)
    load(rpdos_[i], static_cast<std::uint16_t>(0x1400 + i), static_cast<std::uint16_t>(0x1600 + i), false);
  for (std::uint16_t i = 0; i < kTpdoCount; ++i)
    load(tpdos_[i], static_cast<std::uint16_t>(0x1800 + i), static_cast<std::uint16_t>(0x1A00 + i), true);
}

void PdoEngine::load(Pdo& pdo, std::uint16_t communication_index, std::uint16_t mapping_index, bool tpdo) {
  pdo = {};
  const auto cob_id = static_cast<std::uint32_t>(parameter(communication_index, 1));
  const std::int64_t type = parameter(communication_index, 2);
  pdo.cob_id = cob_id & kIdBits;
  pdo.type = static_cast<std::uint8_t>(type);
  pdo.inhibit = hundreds_of_us(parameter(communication_index, 3));
  pdo.event = milliseconds_of(parameter(communication_index, 5));
  if (tpdo) pdo.sync_start = static_cast<std::uint8_t>(parameter(communication_index, 6));
  const bool mapped = build_mapping(mapping_index, static_cast<int>(parameter(mapping_index, 0)), tpdo,
                                    pdo.map) == AbortCode::kNone;
  pdo.valid = mapped && valid_type(type) && (cob_id & (kOff | kExtended | kUnusedIdBits)) == 0 &&
              !cob_id::is_restricted(pdo.cob_id);
  if (operational_ && pdo.valid) start(pdo, tpdo, now_);
}

AbortCode PdoEngine::resolve(std::uint32_t mapping, bool tpdo, MappedObject& object) const {
  const ObjectAddress address{static_cast<std::uint16_t>(mapping >> 16),
                              static_cast<std::uint8_t>(mapping >> 8)};
  const unsigned bits = mapping & 0xFF;
  if (address.index < 0x20 && address.subindex == 0 && !tpdo) {  // dummy: a data type's number
    const std::uint8_t bytes =
        address.index == 0 ? std::uint8_t{0} : size_of(static_cast<DataType>(address.index));
    if (bytes == 0 || bits != bytes * 8u) return AbortCode::kNotMappable;
    object = {-1, bytes};
    return AbortCode::kNone;
  }
  int place = 0;
  if (const AbortCode missing = objects_.locate(address, place); missing != AbortCode::kNone) return missing;
  const ObjectEntry& entry = objects_.table()[place];
  if (!entry.maps_to(tpdo ? Mapping::kTpdo : Mapping::kRpdo) || bits != entry.size() * 8u)
    return AbortCode::kNotMappable;
  object = {static_cast<std::int16_t>(place), entry.size()};
  return AbortCode::kNone;
}

AbortCode PdoEngine::build_mapping(std::uint16_t mapping_index, int count, bool tpdo, Mapping8& map) const {
  map = {};
  if (count > 8) return AbortCode::kPdoLength;
  for (int i = 0; i < count; ++i) {
    MappedObject object;
    const auto mapping =
        static_cast<std::uint32_t>(parameter(mapping_index, static_cast<std::uint8_t>(i + 1)));
    if (const AbortCode refused = resolve(mapping, tpdo, object); refused != AbortCode::kNone) return refused;
    if (map.length + object.bytes > 8) return AbortCode::kPdoLength;
    map.objects[map.count++] = object;
    map.length = static_cast<std::uint8_t>(map.length + object.bytes);
  }
  return AbortCode::kNone;
}

AbortCode PdoEngine::accept(const ObjectEntry& entry, std::int64_t value) {
  Pdo* pdo = pdo_of(entry.address);
  if (pdo == nullptr) return AbortCode::kNoObject;
  return (entry.address.index & 0x200) == 0 ? accept_communication(*pdo, entry, value)
                                            : accept_mapping(*pdo, entry, value);
}

AbortCode PdoEngine::accept_communication(Pdo& pdo, const ObjectEntry& entry, std::int64_t value) {
  switch (entry.address.subindex) {
    case 1: {
      const auto raw = static_cast<std::uint32_t>(value);
      if ((raw & kExtended) != 0 || (raw & kUnusedIdBits) != 0) return AbortCode::kInvalidValue;
      // Nobody can ask for a TPDO by a remote frame here.
      if (is_tpdo(entry.address) && (raw & kNoRtr) == 0) return AbortCode::kInvalidValue;
      const bool on = (raw & kOff) == 0;
      const std::uint32_t id = raw & kIdBits;
      if (on && cob_id::is_restricted(id)) return AbortCode::kInvalidValue;
      // A valid PDO has to be switched off before its identifier may change.
      if (on && pdo.valid && id != pdo.cob_id) return AbortCode::kInvalidValue;
      const bool starts = on && !pdo.valid;
      pdo.cob_id = id;
      pdo.valid = on;
      pdo.waiting = pdo.due = pdo.missing = false;
      pdo.timer = LocalTime::max();
      if (starts && operational_) start(pdo, is_tpdo(entry.address), now_);
      return AbortCode::kNone;
    }
    case 2:
      if (!valid_type(value)) return AbortCode::kInvalidValue;
      pdo.type = static_cast<std::uint8_t>(value);
      pdo.syncs = 0;
      pdo.sync_started = false;
      return AbortCode::kNone;
    case 3:
      if (pdo.valid) return AbortCode::kUnsupportedAccess;
      pdo.inhibit = hundreds_of_us(value);
      return AbortCode::kNone;
    case 5:
      pdo.event = milliseconds_of(value);
      pdo.missing = false;
      pdo.timer = LocalTime::max();
      if (is_tpdo(entry.address) && operational_ && pdo.valid && value != 0) pdo.timer = now_ + pdo.event;
      return AbortCode::kNone;
    case 6:
      if (pdo.valid) return AbortCode::kUnsupportedAccess;
      pdo.sync_start = static_cast<std::uint8_t>(value);
      return AbortCode::kNone;
    default:
      return AbortCode::kNoSubindex;
  }
}

AbortCode PdoEngine::accept_mapping(Pdo& pdo, const ObjectEntry& entry, std::int64_t value) {
  if (pdo.valid) return AbortCode::kUnsupportedAccess;
  const bool tpdo = is_tpdo(entry.address);
  if (entry.address.subindex == 0) {
    Mapping8 map;
    const AbortCode refused = build_mapping(entry.address.index, static_cast<int>(value), tpdo, map);
    if (refused == AbortCode::kNone) pdo.map = map;
    return refused;
  }
  if (pdo.map.count != 0) return AbortCode::kUnsupportedAccess;
  MappedObject object;
  return value == 0 ? AbortCode::kNone : resolve(static_cast<std::uint32_t>(value), tpdo, object);
}

void PdoEngine::start(Pdo& pdo, bool tpdo, LocalTime now) {
  pdo.waiting = pdo.sync_started = pdo.missing = false;
  pdo.syncs = 0;
  pdo.not_before = now;
  pdo.timer = LocalTime::max();
  pdo.due = false;
  if (!tpdo) return;
  if (pdo.type == 0) pdo.waiting = true;
  if (!synchronous(pdo.type)) pdo.due = true;
  if (!synchronous(pdo.type) && pdo.event.count() != 0) pdo.timer = now + pdo.event;
}

void PdoEngine::set_operational(bool operational, LocalTime now) {
  now_ = now;
  if (operational == operational_) return;
  operational_ = operational;
  for (Pdo& pdo : rpdos_) start(pdo, false, now);
  for (Pdo& pdo : tpdos_) start(pdo, true, now);
}

bool PdoEngine::rpdo_missing() const {
  return std::any_of(rpdos_.begin(), rpdos_.end(), [](const Pdo& pdo) { return pdo.valid && pdo.missing; });
}

void PdoEngine::report(std::uint16_t code, const Pdo& pdo, ObjectAddress object) {
  if (problem_count_ == problems_.size()) return;
  problems_[problem_count_++] = {code, static_cast<std::uint8_t>(&pdo - rpdos_.data() + 1), object};
}

std::optional<PdoEngine::Problem> PdoEngine::next_problem() {
  if (problem_count_ == 0) return std::nullopt;
  const Problem problem = problems_[0];
  std::copy(problems_.begin() + 1, problems_.end(), problems_.begin());
  --problem_count_;
  return problem;
}

PdoEngine::Reception PdoEngine::on_frame(LocalTime now, const CanFrame& frame) {
  now_ = now;
  if (!operational_ || frame.extended || frame.remote) return Reception::kNotMine;
  for (Pdo& pdo : rpdos_) {
    if (!pdo.valid || pdo.cob_id != frame.id || pdo.map.count == 0) continue;
    if (frame.length < pdo.map.length) {
      report(emcy::kPdoTooShort, pdo);
      return Reception::kRefused;
    }
    // Longer than mapped: what is mapped is used, the rest told.
    if (frame.length > pdo.map.length) report(emcy::kPdoTooLong, pdo);
    pdo.missing = false;
    if (pdo.event.count() != 0) pdo.timer = now + pdo.event;
    if (!synchronous(pdo.type)) return write(pdo, frame);
    pdo.frame = frame;
    pdo.waiting = true;
    return Reception::kAwaitsSync;
  }
  return Reception::kNotMine;
}

/// All of it, or, for one value that its object cannot have, nothing.
PdoEngine::Reception PdoEngine::write(Pdo& pdo, const CanFrame& frame) {
  Reception result = Reception::kWritten;
  for (const bool trial : {true, false}) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < pdo.map.count; ++i) {
      const MappedObject& object = pdo.map.objects[i];
      const std::uint64_t raw = get_le(std::span(frame.data).subspan(at), object.bytes);
      at += object.bytes;
      if (object.place < 0) continue;
      const ObjectEntry& entry = objects_.table()[object.place];
      const std::int64_t value = value_of(entry.type, raw);
      if (!trial) {
        if (objects_.write_value(object.place, value) != AbortCode::kNone) result = Reception::kRefused;
      } else if (objects_.check_value(object.place, value) != AbortCode::kNone) {
        report(emcy::kPdoRefused, pdo, entry.address);
        return Reception::kRefused;
      }
    }
  }
  return result;
}

void PdoEngine::on_sync(LocalTime now, std::uint8_t counter) {
  now_ = now;
  if (!operational_) return;
  for (Pdo& pdo : rpdos_) {
    if (!pdo.valid || !pdo.waiting) continue;
    pdo.waiting = false;
    write(pdo, pdo.frame);
  }
  for (Pdo& pdo : tpdos_) {
    if (!pdo.valid || !synchronous(pdo.type)) continue;
    if (pdo.type == 0) {  // acyclic: at the SYNC after an event
      CanFrame fresh;
      const bool changed = pack(pdo, fresh) && fresh.data != pdo.frame.data;
      pdo.due = pdo.due || pdo.waiting || changed;
      pdo.waiting = false;
      continue;
    }
    if (!pdo.sync_started) {
      if (pdo.sync_start != 0 && counter != 0 && counter != pdo.sync_start) continue;
      pdo.sync_started = true;
      pdo.syncs = pdo.sync_start != 0 ? static_cast<std::uint8_t>(pdo.type - 1) : std::uint8_t{0};
    }
    if (++pdo.syncs < pdo.type) continue;
    pdo.syncs = 0;
    pdo.due = true;
  }
}

void PdoEngine::on_time(LocalTime now) {
  now_ = now;
  if (!operational_) return;
  for (Pdo& pdo : rpdos_) {
    if (!pdo.valid || now < pdo.timer) continue;
    pdo.timer = LocalTime::max();
    pdo.missing = true;
    report(emcy::kRpdoTimeout, pdo);
  }
  for (Pdo& pdo : tpdos_) {
    if (!pdo.valid || synchronous(pdo.type)) continue;
    if (now >= pdo.timer) pdo.due = true;
    CanFrame fresh;
    if (pdo.type == 255 && !pdo.due && now >= pdo.not_before && pack(pdo, fresh) &&
        fresh.data != pdo.frame.data)
      pdo.due = true;
  }
}

void PdoEngine::trigger(int number) {
  Pdo& pdo = tpdos_[static_cast<std::size_t>(number - 1)];
  if (!pdo.valid || !operational_) return;
  if (pdo.type == 0) pdo.waiting = true;
  if (!synchronous(pdo.type)) pdo.due = true;
}

bool PdoEngine::pack(Pdo& pdo, CanFrame& frame) {
  frame = CanFrame{.id = pdo.cob_id, .length = pdo.map.length};
  std::size_t at = 0;
  for (std::size_t i = 0; i < pdo.map.count; ++i) {
    const MappedObject& object = pdo.map.objects[i];
    std::int64_t value = 0;
    if (objects_.read_value(object.place, value) != AbortCode::kNone) return false;
    put_le(std::span(frame.data).subspan(at), static_cast<std::uint64_t>(value), object.bytes);
    at += object.bytes;
  }
  return pdo.map.count != 0;
}

std::optional<CanFrame> PdoEngine::next_frame(LocalTime now) {
  now_ = now;
  if (!operational_) return std::nullopt;
  for (Pdo& pdo : tpdos_) {
    if (!pdo.valid || !pdo.due) continue;
    if (!synchronous(pdo.type) && now < pdo.not_before) continue;
    pdo.due = false;
    CanFrame frame;
    if (!pack(pdo, frame)) continue;
    pdo.frame = frame;
    pdo.not_before = now + pdo.inhibit;
    if (!synchronous(pdo.type) && pdo.event.count() != 0) pdo.timer = now + pdo.event;
    return frame;
  }
  return std::nullopt;
}

LocalTime PdoEngine::next_deadline() const {
  LocalTime earliest = LocalTime::max();
  if (!operational_) return earliest;
  for (const Pdo& pdo : rpdos_)
    if (pdo.valid) earliest = std::min(earliest, pdo.timer);
  for (const Pdo& pdo : tpdos_) {
    if (!pdo.valid) continue;
    earliest = std::min(earliest, pdo.timer);
    if (pdo.due) earliest = std::min(earliest, synchronous(pdo.type) ? now_ : pdo.not_before);
    // A change held back by the inhibit time is looked for when that ends.
    if (pdo.type == 255 && pdo.not_before > now_) earliest = std::min(earliest, pdo.not_before);
  }
  return earliest;
}

}  // namespace kinebus
