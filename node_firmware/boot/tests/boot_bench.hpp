#pragma once
// A boot loader on flash that can lose its power, and images for it.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/boot/handover.hpp"
#include "node_firmware/core/tests/flash_model.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"
#include "protocol/canopen/sdo_client.hpp"

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
    if (!erases) return false;
    model.erase(0, model.bytes().size());
    ++erasures;
    return true;
  }
  bool program(std::uint32_t offset, std::uint32_t word) override {
    ++programmed;
    return offset < fails_from && model.program(offset, word);
  }
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
    return says_that_it_locks;
  }
  FlashModel model;
  std::vector<std::uint8_t> record_memory = std::vector<std::uint8_t>(64, 0xFF);  ///< two slots
  int erasures = 0, programmed = 0;                                               ///< programmed: words
  bool erases = true;
  std::uint32_t fails_from = 0xFFFF'FFFF;
  std::uint8_t missing = kNoBrownOut | kBootLoaderOpen;
  bool locks = true, says_that_it_locks = true;
};

inline constexpr std::size_t kBootRoom = 8192;

// A board: reset starts the program or the boot loader, as their handover and the flash say.
struct BootBench : testing::Test {
  ModelFlash flash{kBootRoom, 5};
  Handover handover{.magic = 0};  // as the RAM comes up
  std::unique_ptr<BootLoader> boot;
  LocalTime now{0};

  bool reset() {
    boot.reset();
    if (start_program(handover, check_image(flash.bytes(), kBootBoard))) return true;
    boot = std::make_unique<BootLoader>(kBootBoard, kBootIdentity, 7, flash, now);
    return false;
  }
  AbortCode transfer(const auto& begin) {
    SdoClient client(SdoClient::Options{.timeout = std::chrono::seconds{10}});
    begin(client);
    for (int i = 0; i < 100'000 && client.status() == SdoClient::Status::kBusy; ++i) {
      now += std::chrono::microseconds{100};
      boot->on_time(now);
      while (const auto frame = client.next_frame()) boot->on_frame(now, *frame);
      while (const auto frame = boot->next_frame()) client.on_frame(now, *frame);
    }
    return client.status() == SdoClient::Status::kDone ? AbortCode::kNone : client.abort_code();
  }
  AbortCode download(std::span<const std::uint8_t> image,
                     SdoClient::Method method = SdoClient::Method::kBlock) {
    return transfer([&](SdoClient& c) { c.download(now, 7, {0x1F50, 1}, image, method); });
  }
  AbortCode control(std::uint8_t command) {
    const std::array<std::uint8_t, 1> byte{command};
    return transfer([&](SdoClient& c) { c.download(now, 7, {0x1F51, 1}, byte); });
  }
  std::uint32_t read(std::uint16_t index, std::uint8_t sub) {
    std::array<std::uint8_t, 4> bytes{};
    EXPECT_EQ(transfer([&](SdoClient& c) { c.upload(now, 7, {index, sub}, bytes); }), AbortCode::kNone);
    return get_u32_le(bytes);
  }
};

}  // namespace kinebus
