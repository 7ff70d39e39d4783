// Any bytes as CAN frames, switch edges and time at a node: it never crashes, and no motor ever steps:
// whatever is sent, positions move no faster than an axis may.
//
// Input: records of kind, time and up to 12 bytes. The first byte sets whether the axes are enabled to begin
// with.

#include <algorithm>
#include <cstdlib>

#include "node_firmware/core/node.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

/// 607Fh, which bounds every motion, is left at its default: 576000 counts/s, in counts a microsecond with 32
/// fractional bits, and 1 % for rounding.
constexpr std::int64_t kFastestPerUs = 582 * kOneCount / 1000;
/// Late commands may set path time back by 5 us, corrections of the clock run it 100 ppm faster.
constexpr std::int64_t kSlackUs = 6;

bool changes_the_bound(const CanFrame& frame) {
  const std::uint16_t index = get_u16_le(std::span(frame.data).subspan(1));
  return frame.id == 0x601 && (index == 0x607F || index == 0x687F);
}

class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool empty() const { return at_ >= size_; }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : data_[at_++]; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

// Identifiers that mean something to node 1, so that the fuzzer need not find them.
constexpr std::array<std::uint32_t, 14> kInteresting{0x000, 0x080, 0x082, 0x1FF, 0x201, 0x301, 0x401,
                                                     0x501, 0x601, 0x2FF, 0x702, 0x77F, 0x7E5, 0x101};

void enable(Node& node, LocalTime now) {
  node.on_frame(now, CanFrame::make(0x000, {1, 1}));
  for (const std::uint8_t word : std::initializer_list<std::uint8_t>{0x06, 0x07, 0x0F})
    node.on_frame(now, CanFrame::make(0x201, {word, 0, word, 0, 7, 1}));
}

/// With good check bits, where a frame has some: the fuzzer would hardly find them.
void seal(CanFrame& frame) {
  constexpr std::uint64_t kTop = std::uint64_t{0xFF} << 56, kStampCheck = std::uint64_t{0x3F} << 26;
  const std::uint64_t raw = get_u64_le(frame.data);
  if (frame.id == kRateCobId) {
    frame.data[7] = check_bits(raw & ~kTop, 8, 0x2F);
  } else if (frame.id == kSyncStampCobId) {
    const std::uint64_t bare = raw & ~kStampCheck;
    put_u64_le(frame.data, bare | std::uint64_t{check_bits(bare, 6, 0x03)} << 26);
  } else if (frame.id > 0x080 && frame.id <= 0x0FF) {
    frame.data[7] = check_bits(raw >> 24 & 0xFFFF'FFFFu, 8, 0x2F);
  }
}

class Session {
 public:
  explicit Session(bool enabled) {
    if (enabled) enable(node_, now_);
    for (int axis = 0; axis < 2; ++axis) last_[static_cast<std::size_t>(axis)] = node_.position(now_, axis);
  }

  void turn(Reader& in) {
    const std::uint8_t kind = in.byte();
    pass(LocalTime{std::int64_t{1} << (in.byte() % 28)});
    switch (kind % 4) {
      case 0:
      case 1: {
        CanFrame frame;
        const std::uint8_t which = in.byte();
        frame.id = which < 0xF0 ? kInteresting[which % kInteresting.size()] : get_u16(in) & 0x7FFu;
        frame.extended = which == 0xFF;
        frame.remote = which == 0xFE;
        frame.length = kind % 4 == 0 ? 8 : in.byte() % 9;
        for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = in.byte();
        if (which < 0xF0) seal(frame);
        if (!changes_the_bound(frame)) node_.on_frame(now_, frame);
        break;
      }
      case 2: {
        const std::uint8_t what = in.byte();
        node_.on_switch(now_, what % 8, (what & 0x80) != 0);
        break;
      }
      case 3:
        if (in.byte() == 0x55) node_.on_drive_fault(now_, in.byte() & 1, 0x2310);
        break;
    }
    drain();
    look();
  }

 private:
  static std::uint16_t get_u16(Reader& in) {
    const unsigned low = in.byte();
    return static_cast<std::uint16_t>(low | (static_cast<unsigned>(in.byte()) << 8));
  }

  void pass(LocalTime span) {
    const LocalTime end = now_ + span;
    for (int i = 0; i < 50 && now_ < end; ++i) {
      now_ = std::clamp(node_.next_deadline(), now_ + LocalTime{1'000}, end);
      look();
      node_.on_time(now_);
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
    for (int axis = 0; axis < 2; ++axis) {
      const std::int64_t here = node_.position(now_, axis);
      std::int64_t& before = last_[static_cast<std::size_t>(axis)];
      const std::int64_t most = (kSlackUs + (now_ - looked_).count() / 1000 + 1) * kFastestPerUs;
      const auto step =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(here) - static_cast<std::uint64_t>(before));
      if (step > most || step < -most) std::abort();
      before = here;
    }
    looked_ = now_;
  }

  LocalTime now_{0};
  LocalTime looked_{0};
  LoneNode node_{{.node_id = 1}, LocalTime{0}};
  std::array<std::int64_t, 2> last_{};
};

}  // namespace
}  // namespace kinebus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kinebus::Reader in(data, size);
  kinebus::Session session((in.byte() & 1) != 0);
  for (int i = 0; i < 400 && !in.empty(); ++i) session.turn(in);
  return 0;
}
