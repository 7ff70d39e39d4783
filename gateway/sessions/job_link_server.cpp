#include "gateway/sessions/job_link_server.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "gateway/sessions/command_requests.hpp"
#include "gateway/sessions/job_check_task.hpp"
#include "gateway/sessions/job_link_session.hpp"
#include "gateway/sessions/job_requests.hpp"
#include "gateway/sessions/machine_requests.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/sha256.hpp"
#include "protocol/joblink/shown_text.hpp"
#include "protocol/joblink/version.hpp"

namespace kinebus {
namespace {

/// So often a running job is looked at for the history; its end is seen at once by its event.
constexpr LocalTime kRecordPeriod = std::chrono::milliseconds{500};
/// Of a job that the machine has taken: 0 s are those of one that it would not take.
constexpr double kShortestRun_s = 0.001;

joblink::MachineInfo info_of(const MachineDescription& machine, const std::string& bus) {
  const auto kinematics = make_kinematics(machine);
  joblink::MachineInfo info = to_message(machine, kinematics ? (*kinematics)->bed_reference() : Pose{});
  if (!bus.empty()) info.set_bus(bus);
  return info;
}

}  // namespace

JobLinkServer::JobLinkServer(Gateway& gateway, const MachineDescription& machine, JobStore& store,
                             Worker& worker, MachineFilePort& machine_file, Control& control, Options options)
    : gateway_(gateway),
      machine_(machine),
      store_(store),
      worker_(worker),
      machine_file_(machine_file),
      control_(control),
      options_(std::move(options)),
      run_id_(std::make_shared<std::int64_t>(0)),
      machine_info_(info_of(machine, options_.bus)) {
  worker_.post([&store = store_, mark = options_.machine_mark] { store.set_machine(mark); }, [] {});
}

JobLinkServer::~JobLinkServer() = default;

std::unique_ptr<ByteSession> JobLinkServer::open(LocalTime now, SessionInfo info) {
  if (info.peer.empty()) info.peer = info.transport;
  if (!info.lasting) make_room(now, &JobLinkSession::stranger, options_.places.strangers);
  return std::make_unique<JobLinkSession>(*this, ++last_session_, std::move(info), now);
}

void JobLinkServer::make_room(LocalTime now, bool (JobLinkSession::*counts)() const, std::size_t most) {
  std::map<std::string, std::pair<std::size_t, JobLinkSession*>> peers;  // how many, and the oldest
  std::size_t all = 0;
  for (const auto& [id, session] : sessions_) {
    if (!(session->*counts)()) continue;
    ++all;
    auto& [count, oldest] = peers[session->info().peer];
    ++count;
    if (oldest == nullptr || session->id() < oldest->id()) oldest = session;
  }
  if (all < most) return;
  const auto greediest = std::max_element(peers.begin(), peers.end(), [](const auto& a, const auto& b) {
    // Of two peers that have as many, the one whose session waits longest.
    return std::pair(a.second.first, b.second.second->id()) <
           std::pair(b.second.first, a.second.second->id());
  });
  greediest->second.second->end(now, "others wait for this place");
}

bool JobLinkServer::has_place_for(const JobLinkSession& session) const {
  const SessionInfo& info = session.info();
  if (info.lasting) return true;
  std::size_t clients = 0, of_side = 0, of_peer = 0;
  for (const auto& [id, other] : sessions_) {
    if (!other->takes_place()) continue;
    ++clients;
    if (other->info().remote == info.remote) ++of_side;
    if (other->info().peer == info.peer) ++of_peer;
  }
  const Places& places = options_.places;
  return clients < places.clients && of_side < places.of_a_side &&
         (!info.remote || of_peer < places.of_a_remote_peer);
}

Requester* JobLinkServer::find(std::uint64_t session) {
  const auto found = requesters_.find(session);
  return found != requesters_.end() ? found->second : nullptr;
}

std::uint64_t JobLinkServer::enter(Requester& requester) {
  requesters_[++last_session_] = &requester;
  return last_session_;
}

void JobLinkServer::request(LocalTime now, Requester& by, const Asker& asker,
                            const joblink::ClientMessage& message) {
  // What is told afterwards is the state after it.
  if (!message.has_get_status()) forget_status();
  if (JobRequests(*this, by, now).take(asker, message)) return;
  if (MachineRequests(*this, by).take(asker, message)) return;
  refuse(asker, problem(joblink::ERROR_NOT_UNDERSTOOD, {}, say("this gateway does not know the request")));
}

void JobLinkServer::answer(const Asker& asker, joblink::Reply reply) {
  Requester* requester = find(asker.session);
  if (requester == nullptr) return;
  reply.set_request_id(asker.request);
  requester->take_reply(std::move(reply));
}

void JobLinkServer::refuse(const Asker& asker, joblink::Problem error) {
  joblink::Reply reply;
  *reply.mutable_error() = std::move(error);
  answer(asker, std::move(reply));
}

joblink::Problem JobLinkServer::no_control() const {
  return problem(joblink::ERROR_NO_CONTROL, {},
                 say("%1 has control of the machine", control_.name_of(control_.holder())),
                 say("ask for it to be handed over, or take control by force"));
}

void JobLinkServer::welcome(LocalTime now, JobLinkSession& session, const joblink::Hello& hello,
                            joblink::HelloReply& reply) {
  latest_ = now;
  forget_status();
  // The same client may be back before its old stream is known to be dead.
  for (const auto& [id, other] : sessions_)
    if (other->client() != 0 && other->resume_key() == hello.resume_key()) {
      other->end(now, "this client has come back on another connection");
      break;
    }
  // Who had control when its link broke is no visitor.
  const bool returns = !vanished_key_.empty() && vanished_key_ == hello.resume_key();
  const bool visits = !returns && !has_place_for(session);
  if (visits) make_room(now, &JobLinkSession::visitor, options_.places.visitors);
  const ClientId client =
      control_.attach(shown(hello.client_name(), kMaxNameBytes), session.info().transport);
  if (returns && control_.take(client, false)) vanished_key_.clear();
  const std::string key =
      joblink::sha256_of(options_.secret + "/" + std::to_string(++keys_made_)).substr(0, 16);
  session.welcomed(now, client, key, visits);
  reply.set_version_major(joblink::kVersionMajor);
  reply.set_version_minor(joblink::kVersionMinor);
  reply.set_gateway_version(options_.version);
  reply.set_machine_name(machine_info_.name());
  reply.set_gateway_id(options_.gateway_id);
  reply.set_client_id(client);
  reply.set_resume_key(key);
  for (const char* what : {"upload", "check", "history", "console", "work_offset", "machine_file", "events"})
    reply.add_capabilities(what);
  reply.set_max_chunk_bytes(JobLinkSession::kMaxChunk);
  reply.set_upload_window_bytes(JobLinkSession::kUploadWindow);
  reply.set_event_id(events_.newest());
}

double JobLinkServer::unix_s(LocalTime now) const {
  return options_.unix_s_at_zero + to_seconds(now);
}

void JobLinkServer::tell(LocalTime now, joblink::Event event) {
  if (event.time_s() == 0) event.set_time_s(to_seconds(now));
  event.set_unix_s(options_.unix_s_at_zero + event.time_s());
  event.set_job(shown(event.job()));
  events_.add(std::move(event));
}

void JobLinkServer::on_event(LocalTime now, const MachineEvent& event) {
  latest_ = now;
  forget_status();
  if (event.kind == MachineEvent::Kind::kState && event.state == MachineState::kRunning &&
      !recorder_.active())
    job_goes_on(gateway_.status().job);
  if (const auto ended = recorder_.on_event(event)) record_end(now, *ended);
  tell(now, to_message(event));
}

const joblink::Status& JobLinkServer::status() {
  if (status_) return *status_;
  gateway_.watch_currents();
  ++statuses_made_;
  status_bytes_.clear();
  status_ = to_message(gateway_.status());
  add_commands(*status_, gateway_);
  status_->set_controller(control_.holder());
  for (const Control::Client& client : control_.clients()) {
    joblink::ClientInfo& info = *status_->add_clients();
    info.set_id(client.id);
    info.set_name(client.name);
    info.set_transport(client.transport);
  }
  return *status_;
}

const std::string& JobLinkServer::status_message() {
  const joblink::Status& present = status();
  if (!status_bytes_.empty()) return status_bytes_;
  joblink::ServerMessage message;
  *message.mutable_status() = present;
  status_bytes_ = message.SerializeAsString();
  return status_bytes_;
}

void JobLinkServer::job_started(const std::string& name, std::int64_t run) {
  recorder_.begin(latest_);
  run_id_ = std::make_shared<std::int64_t>(run);
  worker_.post([&store = store_, name] { store.keep_what_runs(name); }, [] {});
}

void JobLinkServer::job_refused(const std::string& name, std::int64_t run, const Sentence& why) {
  worker_.post([&store = store_, name, run, words = why.english(),
                said = to_message(why).SerializeAsString()] { store.refuse_run(run, name, words, said); },
               [] {});
}

void JobLinkServer::job_goes_on(const std::string& name) {
  recorder_.begin(latest_);
  run_id_ = std::make_shared<std::int64_t>(0);
  worker_.post(
      [&store = store_, id = run_id_, name, unix_s = unix_s(latest_)] {
        const auto job = store.find(name);
        if (!job) return;
        StoredRun run{.name = name, .begun_unix_s = unix_s};
        run.hash = job->hash;
        if (const auto begun = store.begin_run(run)) *id = *begun;
      },
      [] {});
}

void JobLinkServer::record_end(LocalTime now, const RunRecorder::Ended& end) {
  static constexpr RunResult kResults[] = {RunResult::kComplete, RunResult::kCancelled, RunResult::kRefused,
                                           RunResult::kFailed};
  worker_.post(
      [&store = store_, id = run_id_, end, goes_on = gateway_.status().interrupted,
       said = end.first_error.empty() ? std::string() : to_message(end.first_error).SerializeAsString()] {
        if (!goes_on) store.forget_kept();
        if (*id != 0)
          static_cast<void>(store.end_run(*id, kResults[static_cast<std::size_t>(end.result)],
                                          std::max(end.duration_s, kShortestRun_s), end.estimate_s, end.line,
                                          end.first_error, said));
      },
      [this, now] {
        joblink::Event event;
        event.set_kind(joblink::EVENT_JOBS);
        tell(now, std::move(event));
      });
}

void JobLinkServer::on_time(LocalTime now) {
  latest_ = now;
  forget_status();
  if (recorder_.active() && now >= next_record_) {
    next_record_ = now + kRecordPeriod;
    recorder_.on_status(gateway_.status());
  }
  if (now >= next_heat_) {
    next_heat_ = now + HeatCourse::kPeriod;
    heat_.take(gateway_.status());
  }
  if (control_.holder() == told_holder_) return;
  told_holder_ = control_.holder();
  joblink::Event event;
  event.set_kind(joblink::EVENT_CONTROL);
  event.set_client(told_holder_);
  const Sentence words =
      told_holder_ != 0 ? say("%1 has control", control_.name_of(told_holder_)) : say("nobody has control");
  event.set_words(words);
  *event.mutable_said() = to_message(words);
  tell(now, std::move(event));
}

LocalTime JobLinkServer::next_deadline() const {
  return recorder_.active() ? std::min(next_record_, next_heat_) : next_heat_;
}

}  // namespace kinebus
