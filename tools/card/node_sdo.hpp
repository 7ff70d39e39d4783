#pragma once
// Objects of one node, read and written by SDO and waited for: for programs that speak to nodes without a
// gateway.

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "protocol/canopen/node_objects.hpp"
#include "tools/node_id/node_ids.hpp"

namespace kinebus {

/// What the node refused or did not answer, in words for the user.
struct CardError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class NodeSdo {
 public:
  /// `table`: the board's objects, by which sizes and signs are known.
  NodeSdo(BusAccess bus, std::uint8_t node, const ObjectTable& table = kNodeTable)
      : bus_(std::move(bus)), node_(node), table_(&table) {}

  /// All may throw CardError.
  std::int64_t read(ObjectAddress address);
  /// What cannot be printed is '?'.
  std::string read_text(ObjectAddress address);
  void write(ObjectAddress address, std::int64_t value);
  /// Lets frames go by for so long.
  void pause(LocalTime time);

  std::uint8_t node() const { return node_; }
  LocalTime now() const { return bus_.now(); }
  void send(const CanFrame& frame) { bus_.send(frame); }

 private:
  const ObjectEntry& entry_of(ObjectAddress address) const;
  std::size_t upload(ObjectAddress address, std::span<std::uint8_t> room);
  template <typename Begin>
  std::size_t transfer(ObjectAddress address, const Begin& begin);

  BusAccess bus_;
  std::uint8_t node_;
  const ObjectTable* table_;
};

}  // namespace kinebus
