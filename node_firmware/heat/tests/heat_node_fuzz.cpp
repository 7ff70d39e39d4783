// Any bytes as CAN frames, samples, edges of tachos and time at a heat node: it never crashes, and no heater
// has power whose sensor was last seen open, nor any with the contactor open.
//
// Input: records of kind, time and up to 12 bytes.

#include <cstdlib>

#include "node_firmware/heat/heat_node.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::heat {
namespace {

constexpr std::uint8_t kId = 1;
constexpr std::array<std::uint32_t, 10> kInteresting{0x000, 0x080, 0x201, 0x301, 0x401,
                                                     0x601, 0x601, 0x601, 0x702, 0x7E5};
/// 20 C of a thermistor of 100 kOhm on 4.7 kOhm.
constexpr std::uint32_t kRoomRatio = 1'007'000;

class Session {
 public:
  Session(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {
    for (std::uint8_t n = 1; n <= 2; ++n) write(0x6110, n, 10'004);
    node_.on_frame(now_, CanFrame::make(0x000, {1, kId}));
    for (int i = 0; i < 20; ++i) pass(LocalTime{10'000'000});
    write(0x7402, 1, 2000);
  }
  void run() {
    for (int i = 0; i < 400 && at_ < size_; ++i) turn();
  }

 private:
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }

  void write(std::uint16_t index, std::uint8_t subindex, std::uint16_t value) {
    CanFrame frame = CanFrame::make(0x601, {0x2B, 0, 0, subindex, 0, 0, 0, 0});
    put_u16_le(std::span(frame.data).subspan(1), index);
    put_u16_le(std::span(frame.data).subspan(4), value);
    node_.on_frame(now_, frame);
    drain();
  }
  void turn() {
    const std::uint8_t kind = byte();
    pass(LocalTime{std::int64_t{1} << (byte() % 31)});
    switch (kind % 4) {
      case 0:
      case 1: {
        CanFrame frame;
        const std::uint8_t which = byte();
        frame.id = which < 0xF0 ? kInteresting[which % kInteresting.size()] : (which * 8u + byte()) & 0x7FFu;
        frame.extended = which == 0xFF;
        frame.remote = which == 0xFE;
        frame.length = kind % 4 == 0 ? 8 : byte() % 9;
        for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = byte();
        node_.on_frame(now_, frame);
        break;
      }
      case 2: {
        const std::uint8_t which = byte();
        const unsigned high = byte(), low = byte();
        ratios_[which % kHeatSensors] = high << 12 | low << 4;
        if ((which & 0x80) != 0) ratios_[which % kHeatSensors] = kFullRatio;
        break;
      }
      case 3:
        node_.on_tacho(byte() % kFans, byte());
        break;
    }
    drain();
    look();
  }
  void pass(LocalTime span) {
    const LocalTime end = now_ + span;
    for (int i = 0; i < 50 && now_ < end; ++i) {
      now_ = std::min(end, now_ + SensorInput::kSamplePeriod);
      node_.on_time(now_);
      for (int s = 0; s < kHeatSensors; ++s) node_.on_sample(now_, s, ratios_[static_cast<std::size_t>(s)]);
      drain();
      look();
    }
    now_ = end;
    node_.on_time(now_);
    look();
  }
  void drain() {
    for (int i = 0; i < 1000 && node_.next_frame(); ++i) {
    }
    if (!node_.image_to_store().empty()) node_.on_image_stored(true);
  }
  void look() {
    bool all_open = true;
    for (const std::uint32_t ratio : ratios_) all_open = all_open && ratio == kFullRatio;
    for (int h = 0; h < kHeaters; ++h) {
      const std::uint32_t output = node_.heater_output(h);
      if (output > kFullPower) std::abort();
      if (output != 0 && (!node_.contactor() || node_.fault(h) != HeaterFault::kNone)) std::abort();
      if (output != 0 && sampled_open_ && all_open) std::abort();
    }
    sampled_open_ = all_open;
  }

  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
  LocalTime now_{0};
  HeatNode node_{{.node_id = kId}, LocalTime{0}};
  std::array<std::uint32_t, kHeatSensors> ratios_{kRoomRatio, kRoomRatio, kRoomRatio,
                                                  kRoomRatio, kRoomRatio, kRoomRatio};
  bool sampled_open_ = false;
};

}  // namespace
}  // namespace kinebus::heat

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kinebus::heat::Session(data, size).run();
  return 0;
}
