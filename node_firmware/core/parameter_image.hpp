#pragma once
// The stored parameters as bytes: every parameter that differs from its default, by address, so that an image
// stays readable when objects are added. The port keeps the bytes; damage is found by length, version and
// CRC-32.
//
//   "KBPI" | version u16 | entries u16 | node id u8, 3 bytes 0 | entries x (index<<8|sub u32, value i64) |
//   CRC-32 u32

#include <array>
#include <cstdint>
#include <span>

#include "protocol/canopen/object_dictionary.hpp"

namespace kinebus {

/// An image in memory that somebody lends: room for all parameters of a table.
class ParameterBytes {
  static constexpr std::size_t kHeader = 12, kEntry = 12, kTail = 4;

 public:
  enum class Load : std::uint8_t { kEmpty, kGood, kDamaged };

  explicit ParameterBytes(std::span<std::uint8_t> room) : room_(room) {}
  static constexpr std::size_t room_for(const ObjectTable& table) {
    std::size_t n = 0;
    for (const ObjectEntry& entry : table.entries) n += entry.binding == Binding::kParameter ? 1 : 0;
    return kHeader + n * kEntry + kTail;
  }

  /// Takes over what the port's memory holds. kDamaged and kEmpty: as after clear().
  Load adopt(std::span<const std::uint8_t> stored);
  /// No parameters, only the node id.
  void clear(std::uint8_t node_id);
  /// The dictionary as it is now. `node_id`: the one in use, which node-id relative values are relative to;
  /// `kept_node_id`: the one to keep in the image.
  void save(const ObjectDictionary& objects, std::uint8_t node_id, std::uint8_t kept_node_id);
  /// Writes the stored values into a dictionary that has its defaults. Addresses that are gone, and values
  /// that are out of their limits now, are left out.
  /// Only objects below `end_index`: for a reset of communication.
  void apply(ObjectDictionary& objects, std::uint8_t node_id, std::uint32_t end_index) const;
  void set_node_id(std::uint8_t node_id);
  std::uint8_t node_id() const;
  std::span<const std::uint8_t> bytes() const;

 private:
  static constexpr std::uint16_t kVersion = 1;

  void begin(std::uint8_t node_id);
  void finish(std::size_t entries);

  std::span<std::uint8_t> room_;
};

/// The image of a node with that table, with room of its own.
template <const ObjectTable& kTable>
class ImageOf {
 public:
  using Load = ParameterBytes::Load;

  // As those of ParameterBytes.
  Load adopt(std::span<const std::uint8_t> stored) { return image().adopt(stored); }
  void clear(std::uint8_t node_id) { image().clear(node_id); }
  void save(const ObjectDictionary& objects, std::uint8_t node_id, std::uint8_t kept_node_id) {
    image().save(objects, node_id, kept_node_id);
  }
  void apply(ObjectDictionary& objects, std::uint8_t node_id, std::uint32_t end_index = 0x10000) {
    image().apply(objects, node_id, end_index);
  }
  void set_node_id(std::uint8_t node_id) { image().set_node_id(node_id); }
  std::uint8_t node_id() { return image().node_id(); }  ///< 0: none stored
  std::span<const std::uint8_t> bytes() { return image().bytes(); }

 private:
  ParameterBytes image() { return ParameterBytes(room_); }

  std::array<std::uint8_t, ParameterBytes::room_for(kTable)> room_{};
};
/// Of a node with an axis pair.
using ParameterImage = ImageOf<kNodeTable>;

}  // namespace kinebus
