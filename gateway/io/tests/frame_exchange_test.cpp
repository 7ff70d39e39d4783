// The order of a turn: what the nodes wait for does not wait for what only the path needs.

#include "gateway/io/frame_exchange.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Takes every frame at once, and notes its COB-ID.
class NotingBus : public BusPort {
 public:
  explicit NotingBus(std::string* order) : order_(order) {}
  int fd() const override { return -1; }
  LocalTime next_deadline() const override { return LocalTime::max(); }
  bool can_send(LocalTime) override { return true; }
  void send(LocalTime, const CanFrame& frame) override { *order_ += " frame " + std::to_string(frame.id); }
  std::optional<Received> receive(LocalTime) override { return std::nullopt; }

 private:
  std::string* order_;
};

/// Has SYNC to send when it is due, and a piece of the path to plan in each turn, which makes a record.
struct PlanningCore {
  std::string* order;
  LocalTime due, planned_until{0};
  bool sync_sent = false, has_record = false;

  LocalTime sync_due() const { return sync_sent ? LocalTime::max() : due; }
  LocalTime next_deadline() const { return planned_until; }
  void on_time(LocalTime) {
    *order += " plans";
    has_record = true;
  }
  std::optional<CanFrame> next_frame(LocalTime now) {
    CanFrame frame{};
    if (now >= sync_due()) {
      sync_sent = true;
      frame.id = 0x80;
      return frame;
    }
    if (!std::exchange(has_record, false)) return std::nullopt;
    frame.id = 0x301;
    return frame;
  }
  void on_frame(LocalTime, const CanFrame&) {}
  void on_frame_sent(LocalTime, const CanFrame&) {}
  void on_bus_failure(LocalTime, const std::string&) {}
};

TEST(FrameExchange, SyncThatIsDueIsSentBeforeAPieceOfThePathIsPlanned) {
  EventLoop loop;
  std::string order;
  NotingBus bus(&order);
  PlanningCore core{.order = &order, .due = loop.now() + LocalTime{1h}};
  exchange_frames(loop, bus, core);
  EXPECT_EQ(order, " plans frame 769");
  core.due = loop.now();
  exchange_frames(loop, bus, core);
  EXPECT_EQ(order, " plans frame 769 frame 128 plans frame 769");
}

}  // namespace
}  // namespace kinebus
