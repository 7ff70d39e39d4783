#pragma once
// One client's conversation on one stream: frames, hello, what it is told without asking, and how much of it
// is taken at once.

#include <cstdint>
#include <string>

#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/requester.hpp"
#include "protocol/joblink/frame_codec.hpp"

namespace kinebus {

class JobLinkSession : public ByteSession, public Requester {
 public:
  JobLinkSession(JobLinkServer& server, std::uint64_t id, SessionInfo info, LocalTime now);
  ~JobLinkSession() override;

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  void on_absence(LocalTime now) override;
  std::span<const std::uint8_t> next_bytes() override;
  void on_bytes_sent(std::size_t count) override;
  bool wants_bytes() const override;
  bool ended() const override { return ended_; }
  /// A token was asked for and said: that a stream of this computer has none is no merit.
  Rank rank() const override;
  void on_closed(LocalTime now, std::string_view why) override;

  std::uint64_t id() const { return id_; }
  ClientId client() const override { return client_; }
  void take_reply(joblink::Reply reply) override;
  bool stop_cuts_heat() const override { return false; }
  const std::string& resume_key() const { return resume_key_; }
  const SessionInfo& info() const { return info_; }
  bool stranger() const { return client_ == 0 && !ended_ && !info_.lasting; }
  bool visitor() const { return visitor_ && client_ != 0 && !ended_; }
  bool takes_place() const { return client_ != 0 && !visitor_ && !ended_ && !info_.lasting; }
  /// `visitor`: all places are taken; it may stop the machine and ask, and leaves soon.
  void welcomed(LocalTime now, ClientId client, std::string resume_key, bool visitor);
  void send(const joblink::ServerMessage& message);
  /// The stream is to be closed, when `why` is told to a client.
  void end(LocalTime now, const char* why);

 private:
  void work(LocalTime now);
  void see_stop();
  bool work_waits() const { return unread_ && !full() && !ended_; }
  void take(LocalTime now, const joblink::FrameView& frame);
  void begin(LocalTime now, const joblink::FrameView& frame);
  void hello(LocalTime now, const joblink::ClientMessage& message);
  void request(LocalTime now, const joblink::ClientMessage& message);
  void refuse_visitor(const JobLinkServer::Asker& asker);
  bool greeted(const JobLinkServer::Asker& asker);
  void leave(LocalTime now);
  void resynchronise(LocalTime now, const char* why);
  /// It leaves by itself at since_ + hello_within.
  bool leaves_soon() const { return visitor() || (stranger() && !awaited_); }
  bool write(std::string_view message);
  bool full() const;

  JobLinkServer& server_;
  std::uint64_t id_;
  SessionInfo info_;
  joblink::FrameReader reader_;
  joblink::SessionSequence incoming_;
  std::uint32_t session_ = 0, sequence_ = 0;
  joblink::FrameQueue out_;

  ClientId client_ = 0;  ///< 0: no hello yet
  std::string resume_key_;
  LocalTime last_heard_{0}, status_period_{0}, next_status_ = LocalTime::max(), now_{0};
  /// A stranger since, or a visitor.
  LocalTime since_{0};
  bool unread_ = false;  ///< whole frames may wait in the reader
  /// It was a client, and its computer is this one: it may have been stopped for a while, and comes back. Did
  /// it not, the stream would have ended.
  bool awaited_ = false;
  bool visitor_ = false, watches_events_ = false, ended_ = false;
  std::uint64_t told_event_ = 0;
  int open_requests_ = 0;  ///< a reply that comes later counts until it is sent
};

}  // namespace kinebus
