#include "vcan_tests/emulator/usb_cable.hpp"

#include <algorithm>
#include <cerrno>

namespace kinebus::emulator {
namespace {

using Answer = OtgHs::Answer;

constexpr int kAddress = 1;
constexpr std::size_t kHeader = 48, kPacket = 64;
constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4;
constexpr std::array<std::uint8_t, 8> kSetAddress{0x00, 5, kAddress, 0, 0, 0, 0, 0};

// USB/IP is big-endian.
std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t index) {
  const std::uint8_t* at = bytes.data() + 4 * index;
  return static_cast<std::uint32_t>(at[0]) << 24 | static_cast<std::uint32_t>(at[1]) << 16 |
         static_cast<std::uint32_t>(at[2]) << 8 | at[3];
}
void set_word(std::vector<std::uint8_t>& bytes, std::size_t index, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[4 * index + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

}  // namespace

void UsbCable::pull() {
  line_.detach();
  addressed_ = false;
  address_step_ = out_toggle_ = 0;
  urbs_.clear();
  input_.clear();
}

// Linux keeps SET_ADDRESS to itself where the bus is virtual.
void UsbCable::give_address() {
  OtgHs& usb = board_.usb();
  constexpr int kSettled = 200;  // turns: 10 ms
  if (address_step_ == 0) usb.bus_reset();
  if (address_step_ == kSettled && usb.setup(0, kSetAddress) != Answer::kAck) return;
  if (address_step_ > kSettled && usb.in(0, 0).answer == Answer::kAck) addressed_ = true;
  ++address_step_;
}

void UsbCable::serve(BusTime now, BusTime sent) {
  if (!line_.error().empty()) return;
  const bool still = line_.receive(input_);
  if (line_.plugged() != plugged_) board_.set_usb_cable(plugged_ = line_.plugged());
  if (!plugged_ || !still || !board_.usb_device_seen()) return pull();
  if (!addressed_) return give_address();
  if (!line_.attached()) return line_.attach();
  take_requests(sent);
  std::array<bool, 16> busy{};
  for (auto urb = urbs_.begin(); urb != urbs_.end() && urb->due <= now;) {
    const auto endpoint = static_cast<std::size_t>(urb->endpoint);
    bool& taken = busy[endpoint * 2 + (urb->in && endpoint != 0 ? 1 : 0)];
    int status = 0;
    const bool first = !taken;
    taken = true;
    if (first && advance(*urb, status)) {
      finish(*urb, status);
      urb = urbs_.erase(urb);
    } else {
      ++urb;
    }
  }
}

void UsbCable::take_requests(BusTime sent) {
  while (input_.size() >= kHeader) {
    const bool carries = word(input_, 0) == kSubmit && word(input_, 3) == 0;
    const std::size_t whole = kHeader + (carries ? word(input_, 6) : 0);
    if (input_.size() < whole) break;
    const auto end = input_.begin() + static_cast<std::ptrdiff_t>(whole);
    take({input_.begin(), end}, sent);
    input_.erase(input_.begin(), end);
  }
}

void UsbCable::take(const std::vector<std::uint8_t>& request, BusTime sent) {
  const std::uint32_t sequence = word(request, 1);
  if (word(request, 0) == kUnlink) {
    const std::uint32_t which = word(request, 5);
    const auto found = std::ranges::find(urbs_, which, &Urb::sequence);
    std::vector<std::uint8_t> reply(kHeader);
    set_word(reply, 0, kUnlinked);
    set_word(reply, 1, sequence);
    set_word(reply, 5, found == urbs_.end() ? 0 : static_cast<std::uint32_t>(-ECONNRESET));
    if (found != urbs_.end()) urbs_.erase(found);
    return line_.send(reply);
  }
  Urb urb;
  urb.due = sent;
  urb.sequence = sequence;
  urb.in = word(request, 3) == 1;
  urb.endpoint = static_cast<int>(word(request, 4) & 7);
  urb.length = word(request, 6);
  std::copy_n(request.begin() + 40, 8, urb.setup.begin());
  if (!urb.in) urb.data.assign(request.begin() + kHeader, request.end());
  if (urb.endpoint == 0) urb.stage = Urb::Stage::kSetup;
  urbs_.push_back(std::move(urb));
}

bool UsbCable::advance(Urb& urb, int& status) {
  if (urb.endpoint != 0) return urb.in ? advance_in(urb, status) : advance_out(urb, status);
  OtgHs& usb = board_.usb();
  const bool data_in = (urb.setup[0] & 0x80) != 0 && urb.length != 0;
  if (urb.stage == Urb::Stage::kSetup) {
    if (usb.setup(kAddress, urb.setup) == Answer::kAck)
      urb.stage = urb.length != 0 ? Urb::Stage::kData : Urb::Stage::kStatus;
    return false;
  }
  if (urb.stage == Urb::Stage::kData) {
    if (!(data_in ? advance_in(urb, status) : advance_out(urb, status))) return false;
    if (status != 0) return true;
    urb.stage = Urb::Stage::kStatus;
    return false;
  }
  const Answer answer = data_in ? usb.out(kAddress, 0, {}, 1) : usb.in(kAddress, 0).answer;
  if (answer == Answer::kNak) return false;
  status = answer == Answer::kAck ? 0 : -EPIPE;
  if (status == 0) note_toggles(urb);
  return true;
}

bool UsbCable::advance_in(Urb& urb, int& status) {
  const auto got = board_.usb().in(kAddress, urb.endpoint);
  if (got.answer == Answer::kNak) return false;
  if (got.answer != Answer::kAck) {
    status = -EPIPE;
    return true;
  }
  urb.data.insert(urb.data.end(), got.bytes.begin(), got.bytes.end());
  if (urb.data.size() > urb.length) status = -EOVERFLOW;
  return got.bytes.size() < kPacket || urb.data.size() >= urb.length;
}

bool UsbCable::advance_out(Urb& urb, int& status) {
  const std::size_t count = std::min(kPacket, urb.data.size() - urb.sent);
  const auto from = urb.data.begin() + static_cast<std::ptrdiff_t>(urb.sent);
  int& toggle = urb.endpoint == 0 ? urb.toggle : out_toggle_;
  const Answer answer =
      board_.usb().out(kAddress, urb.endpoint, {from, from + static_cast<std::ptrdiff_t>(count)}, toggle);
  if (answer == Answer::kNak) return false;
  if (answer != Answer::kAck) {
    status = -EPIPE;
    return true;
  }
  toggle ^= 1;
  urb.sent += count;
  return urb.sent == urb.data.size();
}

// A new configuration, or an endpoint that is released, begins at DATA0.
void UsbCable::note_toggles(const Urb& urb) {
  const bool configuration = urb.setup[0] == 0x00 && urb.setup[1] == 9;
  const bool released = urb.setup[0] == 0x02 && urb.setup[1] == 1 && urb.setup[4] == 1;
  if (configuration || released) out_toggle_ = 0;
}

void UsbCable::finish(const Urb& urb, int status) {
  std::vector<std::uint8_t> reply(kHeader);
  set_word(reply, 0, kSubmitted);
  set_word(reply, 1, urb.sequence);
  set_word(reply, 5, static_cast<std::uint32_t>(status));
  set_word(reply, 6, static_cast<std::uint32_t>(urb.in ? urb.data.size() : urb.sent));
  if (urb.in) reply.insert(reply.end(), urb.data.begin(), urb.data.end());
  line_.send(reply);
}

}  // namespace kinebus::emulator
