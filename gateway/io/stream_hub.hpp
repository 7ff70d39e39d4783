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
    std::size_t max_streams = 64;
    /// Of one stream in one turn of the loop.
    std::size_t bytes_per_turn = 256U << 10;
  };

  explicit StreamHub(EventLoop& loop);
  StreamHub(EventLoop& loop, Options options);
  ~StreamHub() override;
  StreamHub(const StreamHub&) = delete;
  StreamHub& operator=(const StreamHub&) = delete;

  /// False: too many streams, both are destroyed.
  bool add(std::unique_ptr<ByteStream> stream, std::unique_ptr<ByteSession> session);

  /// Lets every session see the time, sends what waits, and ends what is to end. Called once a turn of the
  /// loop.
  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  std::size_t streams() const { return pairs_.size(); }

 private:
  struct Pair;
  void on_ready(Pair& pair, std::uint32_t events);
  void send(Pair& pair);
  void close(Pair& pair, const char* why);

  EventLoop& loop_;
  Options options_;
  std::vector<std::unique_ptr<Pair>> pairs_;
};

}  // namespace kinebus
