#pragma once
// Joins streams with the sessions that speak on them, within the daemon's loop: moves bytes both ways in
// bounded portions, so that no client keeps the loop from the bus.

#include <cstdint>
#include <memory>
#include <vector>

#include "gateway/io/byte_stream.hpp"
#include "gateway/io/daemon_part.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/sessions/byte_session.hpp"

namespace kinebus {

class StreamHub : public DaemonPart {
 public:
  struct Options {
    std::size_t max_streams = 96;
    /// A session that has ended has so long to send the rest.
    LocalTime farewell = std::chrono::seconds{2};
    /// Of one stream in one turn of the loop.
    std::size_t bytes_per_turn = 64U << 10;
    /// Of all streams in one turn: then bus and machine come first, and whoever had no part of it after that.
    LocalTime work_per_turn = std::chrono::microseconds{500};
    /// Of the processor that the loop has, for good; what was not used is kept for `burst`. The loop runs at
    /// real-time priority: a flood that took all would leave nothing to the planner on a board of one core,
    /// and the kernel stops who never sleeps (sched_rt_runtime_us) for 50 ms each second.
    double share = 0.6;
    LocalTime burst = std::chrono::milliseconds{200};
    /// A stall of the loop so long is told to the sessions: they allow their clients several times that.
    LocalTime absence = std::chrono::seconds{1};
  };

  explicit StreamHub(EventLoop& loop);
  StreamHub(EventLoop& loop, Options options);
  ~StreamHub() override;
  StreamHub(const StreamHub&) = delete;
  StreamHub& operator=(const StreamHub&) = delete;

  /// False: too many streams, both are destroyed.
  bool add(std::unique_ptr<ByteStream> stream, std::unique_ptr<ByteSession> session);

  /// A listener's fd in the loop: nobody is let in there either while streams rest.
  void add_door(int fd) { doors_.push_back(fd); }
  /// Somebody is let in: what follows, up to add(), is streams' work, too.
  void let_in() { static_cast<void>(time_left()); }

  /// Lets every session see the time, sends what waits, and ends what is to end. Called once a turn of the
  /// loop.
  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  void on_stall(LocalTime now, LocalTime length) override;
  LocalTime next_deadline() const override;
  std::size_t streams() const { return pairs_.size(); }

 private:
  struct Pair;
  void on_some_ready();
  void on_ready(Pair& pair, std::uint32_t events);
  void pay(LocalTime now);
  void watch_all(std::uint32_t events);
  void serve(Pair& pair, LocalTime now);
  bool time_left();
  void send(Pair& pair);
  void watch(Pair& pair, bool has_output);
  void close(Pair& pair, const char* why);

  EventLoop& loop_;
  Options options_;
  int epoll_;  ///< of all streams: the loop looks at this one, and not while they rest
  std::vector<std::unique_ptr<Pair>> pairs_;
  std::vector<int> doors_;
  std::size_t first_ = 0;                    ///< who is served first in the next turn
  LocalTime work_until_ = LocalTime::max();  ///< of this turn; max: it has not begun
  LocalTime credit_, paid_{0};               ///< what streams may use now; when that was counted
  LocalTime began_{0};                       ///< the loop's processor time when the turn's work began
  LocalTime rest_until_{0};
};

}  // namespace kinebus
