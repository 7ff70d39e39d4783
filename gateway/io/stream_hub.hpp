#pragma once
// Joins streams with the sessions that speak on them, within the daemon's loop: moves bytes both ways in
// bounded portions, so that no client keeps the loop from the bus. Who may stop the machine has a lane of its
// own, which the others do not fill; who comes by another door than the crowd does not wait with it.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/io/byte_stream.hpp"
#include "gateway/io/daemon_part.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/frugality.hpp"
#include "gateway/io/longest_piece.hpp"
#include "gateway/io/work_gate.hpp"
#include "gateway/sessions/byte_session.hpp"

namespace kinebus {

class StreamHub : public DaemonPart, private WorkGate {
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
    /// Nothing is put off for longer because something is due (keep_clear_of()).
    LocalTime most_kept_clear = std::chrono::milliseconds{10};
    /// A stall of the loop so long is told to the sessions: they allow their clients several times that.
    LocalTime absence = std::chrono::seconds{1};
    /// What a session has heard is carried out at once, not when it is its turn.
    bool at_once = false;
    /// Of a lane: of each of its streams.
    Frugality::Options frugal{};
    /// And of all of them together, in equal parts: many who take little each would fill the lane.
    double frugal_together = 1;
  };

  /// Streams that are added apart have a lane of their own, and places, while no better one has them.
  enum class Side : std::uint8_t { kCommon, kApart };

  explicit StreamHub(EventLoop& loop);
  StreamHub(EventLoop& loop, Options options);
  ~StreamHub() override;
  StreamHub(const StreamHub&) = delete;
  StreamHub& operator=(const StreamHub&) = delete;

  /// Nothing is begun that might not be done when `due()`, a time of the loop, comes (max: none); until then
  /// streams rest. What may take so long is what has lately taken longest. Behind each such rest they have a
  /// turn.
  void keep_clear_of(const std::function<LocalTime()>& due);

  /// Frugal streams whose session is of this rank are served by a lane: a hub with a share of its own, which
  /// counts as this one's, too. It does not rest when this one does.
  void add_lane(ByteSession::Rank rank, const Options& options);
  /// A lane for what is added apart, of whatever rank; the other lanes come before it.
  void add_side(const Options& options);
  /// Before each piece of this one's work the other is looked at; where it had something to do, that goes out
  /// on the bus first. Lanes come before their hub as it is.
  void comes_after(StreamHub& other);
  /// What of this one's share nobody uses, the other one may use besides its own.
  void leaves_to(StreamHub& other) { heir_ = &other; }

  /// False: too many streams, both are destroyed.
  bool add(std::unique_ptr<ByteStream> stream, std::unique_ptr<ByteSession> session,
           Side side = Side::kCommon);

  /// For work that comes by this fd of the loop: it is not watched while streams rest.
  WorkGate& gate(int fd, Side side = Side::kCommon);

  /// Lets every session see the time, sends what waits, and ends what is to end. Called once a turn of the
  /// loop.
  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  void on_stall(LocalTime now, LocalTime length) override;
  LocalTime next_deadline() const override;
  std::size_t streams() const;
  /// In the lanes of their ranks.
  std::size_t streams_first() const;

 private:
  struct Pair;
  static constexpr std::size_t kRanks = 3, kSide = kRanks;
  void on_some_ready();
  bool looked_at();
  bool others_had_something();
  void sort_into_lanes();
  void hand_over(std::size_t index, StreamHub& to);
  StreamHub* lane_of(const Pair& pair) const;
  StreamHub& home_of(Side side);
  std::size_t streams_of(Side side) const;
  bool has_lanes() const {
    return std::ranges::any_of(lanes_, [](const auto& lane) { return lane != nullptr; });
  }
  void note(Pair& pair, LocalTime begin);
  void begin_work();
  void end_work();
  void on_ready(Pair& pair, std::uint32_t events);
  void pay(LocalTime now);
  bool begins() override;
  void ends() override;
  void watch_all(std::uint32_t events);
  void serve(Pair& pair, LocalTime now);
  bool time_left();
  void see_what_is_due();
  bool in_the_way(LocalTime now) const { return !waited_ && clear_from_ <= now && now < clear_to_; }
  void send(Pair& pair);
  void watch(Pair& pair, bool has_output);
  void close(Pair& pair, const char* why);

  EventLoop& loop_;
  Options options_;
  int epoll_;   ///< of all streams: the loop looks at this one, and not while they rest
  int glance_;  ///< of that one: whether it has any, without changing whose turn is next
  std::vector<std::unique_ptr<Pair>> pairs_;
  std::vector<int> doors_;
  std::array<std::unique_ptr<StreamHub>, kRanks + 1> lanes_;  ///< by rank, and the side
  StreamHub* whole_ = nullptr;                                ///< whose lane this is
  std::vector<StreamHub*> before_;
  StreamHub* heir_ = nullptr;  ///< of what this one's share leaves over
  LocalTime looks_at_{0};
  std::size_t first_ = 0;                    ///< who is served first in the next turn
  LocalTime work_until_ = LocalTime::max();  ///< of this turn; max: it has not begun
  LocalTime credit_, paid_{0};               ///< what streams may use now; when that was counted
  std::optional<LocalTime> works_since_;     ///< by the loop's processor time
  LocalTime counted_{0};                     ///< up to here it was some stream's
  LocalTime used_{0};                        ///< of that time in this turn
  LocalTime owed_{0};                        ///< of it, to the hub whose lane this is
  LocalTime rest_until_{0};
  LocalTime gate_opened_{0};
  std::function<LocalTime()> due_;
  LongestPiece longest_;
  LocalTime clear_from_{0}, clear_to_{0};  ///< in this turn, by the computer's time
  bool clears_ = false;                    ///< streams rest because something is due
  bool waited_ = false;                    ///< they have: the next turn is theirs, whatever is due again
};

}  // namespace kinebus
