#pragma once
// A node's object dictionary at run time: the values of its table's objects, with CiA 301's rules for access.
//
//   class Node : ObjectOwner { NodeDictionary objects_{*this}; ... };
//   objects_.value(slot_of(object::kStopRamp))                    what the node itself uses: no checks, no
//   search objects_.value(slot_of_axes(object::kTargetPosition)[axis]) objects_.read(address, bytes, length)
//   /  objects_.write(address, bytes)      what the bus uses: all checks

#include <array>
#include <cstdint>
#include <span>

#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {

/// The device behind a dictionary: has the live values, and may refuse any new one.
class ObjectOwner {
 public:
  /// Value now of an object bound as Binding::kLive.
  virtual AbortCode read(const ObjectEntry& entry, std::int64_t& value) = 0;
  /// `value` is about to become that of `entry`; existence, access, length and limits are checked. For a live
  /// object the owner takes it; for the others the dictionary stores it when this returns kNone.
  virtual AbortCode write(const ObjectEntry& entry, std::int64_t value) = 0;
  /// Whether write() would take this value at another time; changes nothing.
  virtual AbortCode check(const ObjectEntry&, std::int64_t) const { return AbortCode::kNone; }

 protected:
  ~ObjectOwner() = default;
};

class ObjectDictionary : public SdoObjects {
 public:
  const ObjectTable& table() const { return table_; }

  /// All values back to their defaults. The owner is not asked.
  void restore(std::uint8_t node_id);

  std::int64_t value(ObjectSlot slot) const { return values_[slot.value]; }
  void set_value(ObjectSlot slot, std::int64_t value) { values_[slot.value] = value; }

  /// Place of an object in the table; -1: no such object.
  int place_of(ObjectAddress address) const;
  /// The same, telling a missing object from a missing subindex.
  AbortCode locate(ObjectAddress address, int& place) const;
  // By place, for PDOs: access rights are those of the mapping, checked when it was made.
  AbortCode read_value(int place, std::int64_t& value);
  AbortCode write_value(int place, std::int64_t value);
  /// Whether `value` is one that the object can have; changes nothing.
  AbortCode check_value(int place, std::int64_t value) const;

  /// By address, for SDO. Numbers are little endian. `bytes` must have room for 8 bytes, or for the longest
  /// string.
  AbortCode read(ObjectAddress address, std::span<std::uint8_t> bytes, std::size_t& length);
  AbortCode write(ObjectAddress address, std::span<const std::uint8_t> bytes);

  /// The same for an SdoServer. Every object here fits one piece.
  AbortCode sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                     std::uint32_t& total) final;
  AbortCode sdo_write(ObjectAddress address, std::uint32_t offset, std::span<const std::uint8_t> bytes,
                      bool last) final;
  std::size_t sdo_size(ObjectAddress address) const final;

  /// CRC-32 (IEEE) over address and value of every parameter: equal configurations have equal fingerprints.
  /// The node id does not count: values relative to it are taken without it.
  std::uint32_t fingerprint() const;

 protected:
  /// `values`: room for one a row of the table. All at their defaults, those relative to the node id with
  /// `node_id` added.
  ObjectDictionary(ObjectOwner& owner, const ObjectTable& table, std::span<std::int64_t> values,
                   std::uint8_t node_id);
  ~ObjectDictionary() = default;

 private:
  ObjectOwner& owner_;
  const ObjectTable& table_;
  std::int64_t* values_;
  std::uint8_t node_id_ = 0;
};

namespace object_table {
template <std::size_t kCapacity>
struct Values {
  std::array<std::int64_t, kCapacity> values{};
};
}  // namespace object_table

/// With room for the values of `kCapacity` objects.
template <std::size_t kCapacity>
class SizedDictionary final : private object_table::Values<kCapacity>, public ObjectDictionary {
 public:
  explicit SizedDictionary(ObjectOwner& owner, std::uint8_t node_id = 0,
                           const ObjectTable& table = kNodeTable)
      : ObjectDictionary(owner, table, this->values, node_id) {}
  SizedDictionary(const SizedDictionary&) = delete;
  SizedDictionary& operator=(const SizedDictionary&) = delete;
};
/// That of a node with an axis pair, on any board.
using NodeDictionary = SizedDictionary<kMostNodeObjects>;

}  // namespace kinebus
