#pragma once
// From a board's units to its table: put in order and checked by the compiler.
//
//   struct SomeBoard { static constexpr BoardFacts kFacts; static constexpr PdoSet kPdos; static constexpr
//   void compose(Rows&); }; BoardObjects<SomeBoard>::kTable

#include "protocol/canopen/board_facts.hpp"
#include "protocol/canopen/object_rows.hpp"

namespace kinebus {

namespace object_table {

constexpr bool is_sorted(std::span<const ObjectEntry> entries) {
  for (std::size_t i = 1; i < entries.size(); ++i)
    if (!(entries[i - 1].address < entries[i].address)) return false;
  return true;
}
constexpr bool limits_hold(std::span<const ObjectRow> rows) {
  for (const ObjectRow& e : rows) {
    ObjectEntry kept = static_cast<ObjectEntry>(e);
    if (kept.type != e.type || kept.code != e.code || kept.axis != e.axis || kept.slot != e.slot)
      return false;
    if (e.type == DataType::kString ? e.initial != 0 : kept.initial() != e.initial) return false;
    if (kept.size() != (e.type == DataType::kString ? e.text.size() : size_of(e.type))) return false;
    const ObjectLimits limits = e.limits();
    kept.limits = &limits;
    if (e.limited && (kept.low() != e.low || kept.high() != e.high)) return false;
    const auto fits = [&](std::int64_t value) {
      return value_of(e.type, static_cast<std::uint64_t>(value)) == value;
    };
    if (e.type != DataType::kString && !fits(e.initial)) return false;
    if (!e.limited) continue;
    if (e.low > e.high || !fits(e.low) || !fits(e.high)) return false;
    if (e.binding != Binding::kLive && (e.initial < e.low || e.initial > e.high)) return false;
  }
  return true;
}
constexpr bool has_all_heads(std::span<const ObjectEntry> entries) {
  std::uint32_t index = 0;
  for (const ObjectEntry& e : entries) {
    if (e.address.index != index && e.address.subindex != 0) return false;
    index = e.address.index;
  }
  return true;
}

struct FoundLimits {
  std::array<ObjectLimits, Rows::kCapacity> limits{};
  std::size_t count = 0;
  std::array<std::uint16_t, Rows::kCapacity> which{};  ///< by row
};
constexpr FoundLimits find_limits(const Rows& rows) {
  FoundLimits found;
  for (std::size_t i = 0; i < rows.count; ++i) {
    if (!rows.rows[i].limited) continue;
    const ObjectLimits wanted = rows.rows[i].limits();
    std::size_t at = 0;
    while (at < found.count && !(found.limits[at] == wanted)) ++at;
    found.limits[at] = wanted;
    if (at == found.count) ++found.count;
    found.which[i] = static_cast<std::uint16_t>(at);
  }
  return found;
}

}  // namespace object_table

template <typename Board>
class BoardObjects {
  static constexpr object_table::Rows kRows = [] {
    object_table::Rows rows;
    Board::compose(rows);
    return rows;
  }();
  static constexpr auto kOrder = kRows.order();
  template <typename Part>
  static constexpr auto part_of_rows() {
    std::array<Part, kRows.count> parts;
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = static_cast<Part>(kRows.rows[kOrder[i]]);
    return parts;
  }
  // Each pair of limits once, and which of them a row has.
  static constexpr auto kFound = object_table::find_limits(kRows);
  static constexpr auto kLimits = [] {
    std::array<ObjectLimits, kFound.count> limits{};
    for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = kFound.limits[i];
    return limits;
  }();

 public:
  static constexpr auto kEntries = [] {
    auto entries = part_of_rows<ObjectEntry>();
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i].limited) entries[i].limits = &kLimits[kFound.which[kOrder[i]]];
    return entries;
  }();
  /// The same places, for programs that speak to people: an image that does not name it does not contain it.
  static constexpr auto kNames = part_of_rows<ObjectNames>();
  static constexpr ObjectTable kTable{kEntries};

  static_assert(object_table::is_sorted(kEntries), "two rows of a board's object table have one address");
  static_assert(object_table::limits_hold(std::span(kRows.rows).first(kRows.count)),
                "a default or limit does not fit its row's type or limits");
  static_assert(object_table::has_all_heads(kEntries), "an object of a board's table has no subindex 0");
};

/// A core that was compiled for the objects of `core` finds their values in a dictionary of `other`, too:
/// what both tables have is at the same places.
constexpr bool shares_slots(const ObjectTable& core, const ObjectTable& other) {
  for (const ObjectEntry& e : core.entries) {
    const int place = other.find(e.address);
    if (place < 0 || other.entries[static_cast<std::size_t>(place)].slot != e.slot) return false;
  }
  return true;
}

}  // namespace kinebus
