#pragma once
// A boot loader on flash that can lose its power, and images for it.

#include <memory>
#include <vector>

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/core/tests/flash_model.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"

namespace kinebus {

inline constexpr LssIdentity kBootIdentity{kVendorId, kProductCode, kRevisionNumber, 0x1234};
inline constexpr ImageTarget kBootBoard = image_target(Stm32f405Board::kFacts);

inline std::vector<std::uint8_t> make_image(std::size_t bytes, std::uint8_t seed,
                                            const ImageHeader& like = image_header_for(kBootBoard)) {
  std::vector<std::uint8_t> image(bytes);
  for (std::size_t i = 0; i < bytes; ++i) image[i] = static_cast<std::uint8_t>(seed + i * i / 7);
  ImageHeader header = like;
  header.length = static_cast<std::uint32_t>(bytes);
  encode_image_header(header, image);
  header.crc = image_crc(image);
  encode_image_header(header, image);
  return image;
}

struct ModelFlash final : ProgramFlash {
  ModelFlash(std::size_t size, std::uint32_t seed) : model(size, seed) {}
  std::span<const std::uint8_t> bytes() const override { return model.bytes(); }
  bool erase() override {
    model.erase(0, model.bytes().size());
    ++erasures;
    return true;
  }
  bool program(std::uint32_t offset, std::uint32_t word) override { return model.program(offset, word); }
  std::span<const std::uint8_t> records() const override { return record_memory; }
  bool add_record(const BoardRecord& record) override {
    const auto slot = board_record::free_slot(record_memory);
    if (!slot) return false;
    const auto words = board_record::encode(record);
    for (std::size_t i = 0; i < words.size(); ++i)
      put_u32_le(std::span(record_memory).subspan(*slot + 4 * i), words[i]);
    return true;
  }
  std::uint8_t unprotected() const override { return missing; }
  bool protect() override {
    if (locks) missing = 0;
    return locks;
  }
  FlashModel model;
  std::vector<std::uint8_t> record_memory = std::vector<std::uint8_t>(64, 0xFF);  ///< two slots
  int erasures = 0;
  std::uint8_t missing = kNoBrownOut | kBootLoaderOpen;
  bool locks = true;
};

}  // namespace kinebus
