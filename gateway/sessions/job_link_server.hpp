#pragma once
// The gateway's end of the job link, sans-IO: several clients at once, of whom one commands the machine and
// all may watch.
//
//   open() -> a session for each stream (byte_session.hpp); the owner moves its bytes
//   on_event: news of the machine, to all who watch        on_time: history of runs, control that moved
//
// What waits for the disk goes through the Worker; the control loop never does.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/control.hpp"
#include "gateway/sessions/event_log.hpp"
#include "gateway/sessions/heat_course.hpp"
#include "gateway/sessions/machine_file_port.hpp"
#include "gateway/sessions/requester.hpp"
#include "gateway/sessions/run_recorder.hpp"
#include "gateway/sessions/worker.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

struct MachineDescription;
class JobLinkSession;
class JobCheckTask;

/// Which stream a session is on, and what it must prove.
struct SessionInfo {
  std::string transport = "local";  ///< shown to clients: "local", "usb", "tcp 10.0.0.7"
  std::string token;                ///< must be said in the hello; empty: none is needed
  /// Who shares places with it: "local uid 1000", "tcp 10.0.0.7". Empty: the transport.
  std::string peer{};
  bool remote = false;   ///< comes over a network
  bool lasting = false;  ///< the stream is there without a client, too (a USB cable), and is the only one
};

class JobLinkServer {
 public:
  /// Nobody can lock others out. Who has not said hello yet has a place of its own kind for some seconds;
  /// when these are taken, the oldest of the peer that holds most of them goes. Who is let in when its peer,
  /// its side (the network, this computer) or the gateway has as many clients as may be is a visitor: it may
  /// stop the machine and ask for its state, and leaves soon. A lasting stream (USB) has its place always.
  struct Places {
    std::size_t clients = 32, of_a_side = 24, of_a_remote_peer = 8;
    std::size_t strangers = 16, visitors = 4;
  };
  struct Options {
    std::string version;        ///< of the gateway
    std::string gateway_id;     ///< the same over restarts
    std::string secret = "?";   ///< random, of this start: makes the keys of clients that come back
    std::string machine_mark;   ///< names the machine file in use: pre-flights stored are valid for it alone
    double unix_s_at_zero = 0;  ///< wall time at time 0 of the monotonic clock
    LocalTime silence_limit =
        std::chrono::seconds{8};  ///< a client that says nothing for so long has vanished
    LocalTime hello_within = std::chrono::seconds{
        10};  ///< of the stream's begin, or of the last client's end; and a visit's length
    Places places{};
    std::string bus{};  ///< it runs on, as clients are told; empty: the machine file's
    /// The daemon is to begin anew; empty: it cannot.
    std::function<void()> restart{};
  };

  /// All of them must outlive the server and its sessions. `store` is touched by `worker` alone.
  JobLinkServer(Gateway& gateway, const MachineDescription& machine, JobStore& store, Worker& worker,
                MachineFilePort& machine_file, Control& control, Options options);
  ~JobLinkServer();
  JobLinkServer(const JobLinkServer&) = delete;
  JobLinkServer& operator=(const JobLinkServer&) = delete;

  std::unique_ptr<ByteSession> open(LocalTime now, SessionInfo info);

  void on_event(LocalTime now, const MachineEvent& event);
  void on_time(LocalTime now);
  LocalTime next_deadline() const;
  /// The wall clock may be set while the gateway runs, and often is long after its start.
  void wall_clock(double unix_s_at_zero) { options_.unix_s_at_zero = unix_s_at_zero; }
  /// A stored job that begin_job() gave (JobStore) was given to the machine, and it took it, or would not.
  void job_started(const std::string& name, std::int64_t run);
  void job_refused(const std::string& name, std::int64_t run, const Sentence& why);

  /// What a request may use to answer, now or later.
  struct Asker {
    std::uint64_t session = 0;
    std::uint32_t request = 0;
  };
  /// Somebody who speaks another language than the job link's asks for the same things: its number, until it
  /// leaves. It is answered by take_reply(), often before request() returns.
  std::uint64_t enter(Requester& requester);
  void leave(std::uint64_t session) { requesters_.erase(session); }
  void request(LocalTime now, Requester& by, const Asker& asker, const joblink::ClientMessage& message);
  const EventLog& events() const { return events_; }
  const Options& options() const { return options_; }
  const joblink::MachineInfo& machine() const { return machine_info_; }
  /// Made once a turn of the loop, however many ask; and anew after a command. Valid until then.
  const joblink::Status& status();
  /// Each that status() makes has a number of its own.
  std::uint64_t statuses_made() const { return statuses_made_; }

 private:
  friend class JobLinkSession;
  friend class JobRequests;
  friend class MachineRequests;

  Requester* find(std::uint64_t session);
  bool has_place_for(const JobLinkSession& session) const;
  /// The oldest of the peer that has most of the sessions that `counts` ends, where there are `most` of them.
  void make_room(LocalTime now, bool (JobLinkSession::*counts)() const, std::size_t most);
  /// Gives the client its number, and its control back if it lost it by vanishing.
  void welcome(LocalTime now, JobLinkSession& session, const joblink::Hello& hello,
               joblink::HelloReply& reply);
  /// Sends the reply if the asker is still there.
  void answer(const Asker& asker, joblink::Reply reply);
  void refuse(const Asker& asker, joblink::Problem problem);
  void tell(LocalTime now, joblink::Event event);
  joblink::Problem no_control() const;
  double unix_s(LocalTime now) const;
  const std::string& status_message();
  void forget_status() { status_.reset(); }
  /// An interrupted job goes on: that is a run of its own.
  void job_goes_on(const std::string& name);
  void record_end(LocalTime now, const RunRecorder::Ended& end);

  Gateway& gateway_;
  const MachineDescription& machine_;
  JobStore& store_;
  Worker& worker_;
  MachineFilePort& machine_file_;
  Control& control_;
  Options options_;
  EventLog events_;
  RunRecorder recorder_;
  HeatCourse heat_;
  std::shared_ptr<std::int64_t> run_id_;  ///< of the history; written by the worker alone
  joblink::MachineInfo machine_info_;

  std::unordered_map<std::uint64_t, JobLinkSession*> sessions_;
  std::unordered_map<std::uint64_t, Requester*> requesters_;  ///< they among them
  std::uint64_t last_session_ = 0;
  std::string vanished_key_;  ///< of the client that lost control by vanishing
  std::uint64_t keys_made_ = 0;
  ClientId told_holder_ = 0;
  LocalTime next_record_{0}, next_heat_{0}, latest_{0};

  std::vector<std::shared_ptr<JobCheckTask>> checks_;
  std::optional<joblink::Status> status_;
  std::string status_bytes_;  ///< of it, as a message; empty: not made yet
  std::uint64_t statuses_made_ = 0;
};

}  // namespace kinebus
