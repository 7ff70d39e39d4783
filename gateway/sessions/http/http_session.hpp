#pragma once
// One connection: requests one after the other, each read, checked, carried out by its task and answered. How
// slow, long or malformed a client may be is decided here, for all requests alike. A request may turn it into
// a websocket (socket.hpp), which has the connection from there on.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/http/caller.hpp"
#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/http/socket.hpp"
#include "gateway/sessions/http/wire/http_reader.hpp"
#include "gateway/sessions/http/wire/target.hpp"
#include "gateway/sessions/job_requests.hpp"

namespace kinebus::http {

struct Answer {
  int status = 200;
  std::string body{};
  std::string type = "application/json";
  std::vector<std::pair<std::string, std::string>> fields{};
  bool may_be_kept = false;  ///< by the client, who asks each time whether it has changed
};

struct Route;

/// What one request asks for: takes its body, and answers by the session, then or later. Lives until the
/// answer is given.
class Task {
 public:
  virtual ~Task() = default;
  virtual void begin() {}
  virtual void on_body(std::string_view bytes) = 0;
  virtual void on_end() = 0;
  /// False: the body waits, and the client with it.
  virtual bool takes_body() const { return true; }
  /// All that was written is on its way: more may be written.
  virtual void on_written() {}
  /// True: the task says itself when the body may come (Session::let_body_come), for clients that wait for
  /// it.
  virtual bool holds_body() const { return false; }
};

class Session : public ByteSession, public Caller {
 public:
  static constexpr LocalTime kHeadWithin = std::chrono::seconds{10};
  static constexpr LocalTime kIdle = std::chrono::seconds{60};
  /// A client that neither sends what it announced nor takes what it asked for.
  static constexpr LocalTime kStall = std::chrono::seconds{30};
  static constexpr LocalTime kLinger = std::chrono::seconds{2};

  /// `address`: where it comes from; its network may be trusted.
  Session(Server& server, LocalTime now, std::string transport, std::string peer,
          std::string_view address = {});
  ~Session() override;

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  void on_absence(LocalTime now) override;
  std::span<const std::uint8_t> next_bytes() override;
  void on_bytes_sent(std::size_t count) override;
  bool wants_bytes() const override;
  bool ended() const override { return socket_ ? socket_->ended() : ended_; }
  Rank rank() const override { return socket_ ? socket_->rank() : ended_ ? Rank::kAny : rank_of_client(); }
  void on_closed(LocalTime now, std::string_view why) override;

  const std::string& peer() const { return peer_; }
  /// Nobody waits for anything on it, or it may not wait.
  bool idle() const { return socket_ ? !socket_->is_in() : task_ == nullptr && out_.empty() && !ended_; }
  bool is_socket() const { return socket_ != nullptr; }

  /// Who it is for whom something is open now; nobody between two requests, as each shows its own key.
  Visitor present() const;
  const std::string& address() const { return address_; }
  /// That one may not ask any more, or not for the same.
  void put_out(LocalTime now);
  /// No place for it.
  void turn_away() { refuse(503, "all places for connections are taken: come back in some seconds"); }

  // For tasks.
  const Head& head() const { return reader_.head(); }
  const Target& target() const { return target_; }
  /// The client is one of PrusaLink's, where OctoPrint has the same path: OctoPrint's show an API key.
  bool of_prusalink() const;
  /// Bytes of an upload that the worker has not written yet are within their bound.
  bool has_window() const { return owed_bytes() < kUploadWindow; }

  void begin_open_ended(const std::string& name, std::uint64_t expected_bytes, bool replace, Then then);
  void send_chunk(std::uint32_t upload, std::uint64_t offset_bytes, std::string_view data, Then then);
  void let_body_come();
  bool unanswered() const { return !answered_ && !ended_; }

  void answer(const Answer& answer);
  void refuse(int status, std::string_view why);
  void refuse(const joblink::Problem& problem, int status = 0);
  /// A long answer: its head, then write() until `length` bytes are written.
  void answer_head(const Answer& head, std::uint64_t length);
  void write(std::string_view bytes);
  void finish();
  /// The answer cannot be given as it was begun.
  void break_off();

 private:
  void work();
  void begin_request();
  void next_request();
  bool work_waits() const;
  void put_head(const Answer& answer, std::uint64_t length);
  void end_exchange();
  std::string_view agent() const;
  void become_socket(const Route& route);
  void recognise();
  void refuse_stranger();
  std::string_view input() const { return std::string_view(in_).substr(at_); }

  std::string transport_, peer_, address_;
  Reader reader_;
  std::string in_, out_;
  std::size_t at_ = 0, sent_ = 0;  ///< of in_ and out_, done with

  Target target_;
  std::unique_ptr<Task> task_, done_task_;
  Digest::Shown shown_ = Digest::Shown::kNothing;
  bool whole_ = false;      ///< the request's body has come
  bool answered_ = false;   ///< its answer is given
  bool no_body_ = false;    ///< HEAD
  bool keep_alive_ = true;  ///< after this answer
  bool starved_ = true;     ///< what has come is too little to go on
  bool lingers_ = false;    ///< what comes is thrown away, so that the client reads the answer
  bool ended_ = false;
  std::unique_ptr<Socket> socket_;

  LocalTime since_, moved_;  ///< since_: of the connection or the last answer; moved_: the last byte
  LocalTime linger_until_ = LocalTime::max();  ///< max: it has not begun
  bool sent_some_ = false;                     ///< since moved_
};

}  // namespace kinebus::http
