#include "vcan_tests/emulator/paced_boards.hpp"

#include <linux/can.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <span>

#include "protocol/bytes.hpp"
#include "protocol/host/kernel_frame.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kPiece = 40us;  // shorter than the shortest frame
constexpr int kMailboxes = 4;     // other participants of the bus may have several frames waiting

bool write_record(const can_frame& record) {
  return std::fwrite(&record, sizeof record, 1, stdout) == 1;
}

class PacedBoards {
 public:
  PacedBoards(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes)
      : machine_(image, nodes, kMailboxes) {}

  void send(const CanFrame& frame) { waiting_.push_back(frame); }
  /// False: nobody reads any more.
  bool go_on(BusTime by) {
    const BusTime end = now_ + by;
    while (now_ < end && said_.empty()) {
      while (!waiting_.empty() && machine_.can_send()) {
        machine_.send(now_, waiting_.front());
        waiting_.pop_front();
      }
      const BusTime next = std::min(end, now_ + kPiece);
      const bool done = machine_.advance(next);
      while (const auto got = machine_.receive()) {
        now_ = std::max(now_, got->when);
        if (!got->own) said_.push_back(got->frame);
      }
      if (done) now_ = next;
    }
    for (; !said_.empty(); said_.pop_front())
      if (!write_record(to_kernel(said_.front()))) return false;
    can_frame time{};
    time.can_id = CAN_ERR_FLAG;
    time.can_dlc = 8;
    put_u64_le(time.data, static_cast<std::uint64_t>(now_.count()));
    return write_record(time) && std::fflush(stdout) == 0;
  }

 private:
  EmulatedMachine machine_;
  BusTime now_{0};
  std::deque<CanFrame> waiting_, said_;
};

}  // namespace

std::string run_paced(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes) {
  PacedBoards boards(image, nodes);
  for (can_frame record{}; std::fread(&record, sizeof record, 1, stdin) == 1;) {
    if (record.can_dlc > 8)
      return "what came is no frame: expected struct can_frame with at most 8 data bytes";
    if ((record.can_id & CAN_ERR_FLAG) == 0)
      boards.send(from_kernel(record));
    else if (!boards.go_on(BusTime{static_cast<std::int64_t>(get_u64_le(record.data))}))
      return "nobody reads what the boards say";
  }
  return {};
}

}  // namespace kinebus::emulator
