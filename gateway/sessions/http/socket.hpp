#pragma once
// A websocket's conversation: frames, pings, places and patience, for all that is spoken over websockets
// alike. What is said and heard is its Dialect's.
//
// A slow reader costs a bounded queue: news are made when there is room for them, and are then the newest.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/http/caller.hpp"
#include "gateway/sessions/http/wire/websocket.hpp"

namespace kinebus::http {

class Dialect {
 public:
  virtual ~Dialect() = default;
  virtual void on_text(std::string_view text) = 0;
  /// News may be said. Called when it is time (next_news), and while there is room.
  virtual void on_room(LocalTime now) = 0;
  virtual LocalTime next_news() const = 0;
};

class Socket : public ByteSession, public Caller {
 public:
  /// Who has not shown the key with its request shows it in its first messages.
  static constexpr LocalTime kLetInWithin = std::chrono::seconds{10};
  /// A client that has said nothing for so long is pinged, and has gone after twice that and a bit.
  static constexpr LocalTime kPingAfter = std::chrono::seconds{20};
  static constexpr LocalTime kGoneAfter = std::chrono::seconds{45};
  static constexpr LocalTime kStall = std::chrono::seconds{30};
  static constexpr std::size_t kMaxBacklog = 1U << 20;
  static constexpr std::size_t kNewsBacklog = 64U << 10;

  Socket(Server& server, LocalTime now, std::string transport, std::string agent);
  ~Socket() override;

  void speak(std::unique_ptr<Dialect> dialect) { dialect_ = std::move(dialect); }
  /// From here on it may ask for what `visitor` may, and counts among the clients as `name`; "": as it called
  /// itself in its request. Who is in already only gains by it.
  void let_in(const Visitor& visitor, std::string_view name);
  bool is_in() const { return is_in_; }

  /// A message.
  void say(std::string_view text);
  bool has_room() const { return !ended_ && out_.size() - sent_ < kNewsBacklog; }
  void end(CloseCode code, std::string_view why);
  /// Whether a request that commands leaves control with this client: after take_control.
  bool keeps_control = false;
  /// As ask(); a client that has not asked for control has it for this request alone.
  void command(const joblink::ClientMessage& message, Then then) override;

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  void on_absence(LocalTime now) override;
  std::span<const std::uint8_t> next_bytes() override;
  void on_bytes_sent(std::size_t count) override;
  bool wants_bytes() const override;
  bool ended() const override { return ended_; }
  Rank rank() const override { return is_in_ && !ended_ ? rank_of_client() : Rank::kAny; }
  void on_closed(LocalTime now, std::string_view why) override;

 private:
  static constexpr int kMaxOpenRequests = 32;

  void work();
  bool work_waits() const;
  bool full() const {
    return out_.size() - sent_ > kMaxBacklog || open_requests_ + asked_beside() >= kMaxOpenRequests;
  }

  std::string transport_, agent_;
  std::unique_ptr<Dialect> dialect_;
  FrameReader reader_;
  std::string in_, out_;
  std::size_t at_ = 0, sent_ = 0;  ///< of in_ and out_, done with
  int open_requests_ = 0;
  bool starved_ = true, is_in_ = false, pinged_ = false, sent_some_ = false, ended_ = false;
  LocalTime since_, heard_, moved_;
};

}  // namespace kinebus::http
