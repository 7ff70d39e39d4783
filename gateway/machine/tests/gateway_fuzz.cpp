// Any frames, commands and times into the gateway core: nothing may crash, hang or break a state rule.
// The input is a script: an op byte, then its operands. Fake nodes answer, so that the deep states are
// reached.

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "gateway/machine/gateway.hpp"
#include "gateway/machine/tests/fake_nodes.hpp"

namespace kinebus {
namespace {

class Script {
 public:
  Script(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool over() const { return at_ >= size_; }
  std::uint8_t byte() { return over() ? std::uint8_t{0} : data_[at_++]; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

CanFrame any_frame(Script& script) {
  CanFrame frame;
  const unsigned kind = script.byte();
  // Mostly identifiers that mean something.
  constexpr std::uint32_t kBases[] = {0x000, 0x080, 0x180, 0x280, 0x380, 0x580, 0x700, 0x7E4};
  frame.id = (kBases[kind & 7] + script.byte() % 128) & 0x7FF;
  frame.remote = (kind & 0x40) != 0;
  frame.extended = (kind & 0x80) != 0;
  frame.length = static_cast<std::uint8_t>(script.byte() % 9);
  for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = script.byte();
  return frame;
}

void give_command(Gateway& gateway, Script& script) {
  static constexpr const char* kJobs[] = {"G1 X10 F3000\nG1 X0\n",
                                          "M109 S60\nG1 X5\n",
                                          "G1 X900\n",
                                          "G4 P100\nM0\nG28\n",
                                          "G2 X10 Y0 I5 F1200\nM104 S0\n",
                                          "M486 S0\nG1 X10 F3000\nM486 S1\nG1 X0\nM486 S-1\nG1 Y5\n"};
  switch (script.byte() % 15) {
    case 0:
      static_cast<void>(gateway.carry_out(command::BringUp{}));
      break;
    case 1:
      static_cast<void>(gateway.carry_out(command::Home{}));
      break;
    case 2:
      static_cast<void>(gateway.carry_out(command::GoToReference{}));
      break;
    case 3:
      static_cast<void>(
          gateway.carry_out(command::Jog{.delta = {1.0 * (script.byte() - 128), 0, 0, 0, 0, 0}}));
      break;
    case 4:
      static_cast<void>(
          gateway.carry_out(command::Run{std::make_unique<StringSource>(kJobs[script.byte() % 6]), "fuzz"}));
      break;
    case 5:
      static_cast<void>(gateway.carry_out(command::Hold{}));
      break;
    case 6:
      static_cast<void>(gateway.carry_out(command::Resume{}));
      break;
    case 7:
      static_cast<void>(gateway.carry_out(command::Cancel{}));
      break;
    case 8:
      static_cast<void>(gateway.carry_out(command::Stop{}));
      break;
    case 9:
      static_cast<void>(gateway.carry_out(command::Clear{}));
      break;
    case 10:
      static_cast<void>(gateway.carry_out(command::SetFeedOverride{script.byte() / 50.0}));
      break;
    case 11:
      static_cast<void>(gateway.carry_out(command::MotorsOff{}));
      break;
    case 12:
      static_cast<void>(gateway.text_line(std::string{'M', static_cast<char>(script.byte()), '1'}));
      break;
    case 13:
      static_cast<void>(gateway.carry_out(
          command::SetTemperature{{static_cast<HeaterKind>(script.byte() % 3), 0}, 1.0 * script.byte()}));
      break;
    case 14:
      static_cast<void>(gateway.carry_out(command::ExcludeObject{std::to_string(script.byte() % 3)}));
      break;
  }
}

/// One frame takes 120 us; time passes in steps of at most 5 ms.
struct Bench {
  MachineDescription machine = default_m1();
  Gateway gateway{machine};
  std::vector<std::unique_ptr<FakeNode>> nodes;
  BusTime now{0};

  Bench() {
    for (std::uint8_t id = 1; id <= 3; ++id) nodes.push_back(std::make_unique<FakeNode>(machine, id));
  }
  void exchange() {
    constexpr BusTime kFrame = std::chrono::microseconds{120};
    for (int frames = 0; frames < 40; ++frames) {
      bool any = false;
      if (const auto frame = gateway.next_frame(now)) {
        any = true;
        now += kFrame;
        gateway.on_frame_sent(now, *frame);
        for (auto& node : nodes) node->on_frame(now, *frame);
      }
      for (auto& node : nodes)
        if (const auto frame = node->next_frame()) {
          any = true;
          now += kFrame;
          gateway.on_frame(now, *frame);
        }
      if (!any) return;
    }
  }
  void run_for(BusTime duration) {
    for (const BusTime end = now + duration; now < end;) {
      const BusTime due = gateway.next_deadline();
      if (due <= now) std::abort();
      now = std::min({end, due, now + std::chrono::milliseconds{5}});
      gateway.on_time(now);
      for (auto& node : nodes) node->on_time(now);
      exchange();
    }
  }
};

}  // namespace
}  // namespace kinebus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  using namespace std::chrono_literals;
  Script script(data, std::min<std::size_t>(size, 600));
  Bench bench;
  if ((script.byte() & 1) == 0) {
    static_cast<void>(bench.gateway.carry_out(command::BringUp{}));
    bench.run_for(1500ms);
  }
  for (const BusTime end = bench.now + 20s; !script.over() && bench.now < end;) {
    switch (script.byte() % 4) {
      case 0:
        bench.gateway.on_frame(bench.now, any_frame(script));
        break;
      case 1:
        give_command(bench.gateway, script);
        break;
      case 2:
        bench.run_for(std::chrono::milliseconds{script.byte()});
        break;
      case 3:
        bench.run_for(std::chrono::milliseconds{10 * script.byte()});
        break;
    }
    const MachineStatus status = bench.gateway.status();
    if (!(status.rate >= 0 && status.rate <= 1) || !(status.progress >= 0 && status.progress <= 1))
      std::abort();
  }
  while (bench.gateway.next_event()) {
  }
  return 0;
}
