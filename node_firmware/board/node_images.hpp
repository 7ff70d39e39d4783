#pragma once
// The parameters of all nodes of a board as one image of the flash store:
//
//   "KBNI" | a length in bytes for each node, u32 | the nodes' images, one behind the other
//
// Any other image is the first node's alone, as a board with one node keeps it.

#include <array>
#include <cstdint>
#include <span>

#include "node_firmware/core/page_store.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {

template <std::size_t kNodes>
class NodeImages {
 public:
  explicit constexpr NodeImages(PageStore& store) : store_(store) {}

  /// What is stored, by node; empty: nothing. Valid until the next save().
  std::array<std::span<const std::uint8_t>, kNodes> load() const {
    std::array<std::span<const std::uint8_t>, kNodes> images{};
    const auto stored = store_.load();
    if (stored.size() < kHead || get_u32_le(stored) != kMagic) {
      images[0] = stored;
      return images;
    }
    std::size_t at = kHead;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const std::size_t length = get_u32_le(stored.subspan(4 + 4 * i));
      if (length > stored.size() - at) return images;
      images[i] = stored.subspan(at, length);
      at += length;
    }
    return images;
  }
  /// False: not stored; what was stored before still is.
  bool save(std::size_t number, std::span<const std::uint8_t> image) const {
    auto images = load();
    images[number] = image;
    std::array<std::uint8_t, kHead> head{};
    put_u32_le(head, kMagic);
    std::array<std::span<const std::uint8_t>, kNodes + 1> parts{head};
    for (std::size_t i = 0; i < kNodes; ++i) {
      put_u32_le(std::span(head).subspan(4 + 4 * i), static_cast<std::uint32_t>(images[i].size()));
      parts[i + 1] = images[i];
    }
    return store_.save(parts);
  }

 private:
  static constexpr std::uint32_t kMagic = 0x494E'424B;
  static constexpr std::size_t kHead = 4 + 4 * kNodes;

  PageStore& store_;
};

}  // namespace kinebus
