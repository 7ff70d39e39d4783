#include "vcan_tests/fleet/gateways/simulated_gateway.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <utility>

#include "protocol/joblink/sha256.hpp"

namespace kinebus::fleet {
namespace {

double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string bytes_of(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

joblink::Reply refused(joblink::ErrorCode code, const char* rule) {
  joblink::Reply reply;
  reply.mutable_error()->set_code(code);
  reply.mutable_error()->set_rule(rule);
  return reply;
}

}  // namespace

/// Lines: "begin NAME HASH UNIX_S", "end RESULT DURATION_S".
SimulatedGateway::SimulatedGateway(const std::string& file, LocalTime job_time) : job_time_(job_time) {
  std::ifstream in(file);
  std::string what, name, hash;
  while (in >> what) {
    double seconds = 0;
    int result = 0;
    if (what == "begin" && in >> name >> hash >> seconds) {
      joblink::JobRun& run = runs_.emplace_back();
      run.set_id(runs_.size());
      run.set_name(name);
      run.set_hash(bytes_of(hash));
      run.set_begun_unix_s(seconds);
    } else if (what == "end" && in >> result >> seconds && !runs_.empty()) {
      runs_.back().set_result(static_cast<joblink::JobResult>(result));
      runs_.back().set_duration_s(seconds);
    }
  }
  file_.open(file, std::ios::app);
  if (!runs_.empty() && runs_.back().result() == joblink::JOB_RUNNING) end(joblink::JOB_INTERRUPTED, 0.1);
}

void SimulatedGateway::begin(const std::string& name, const std::string& hash, double unix_s) {
  file_ << "begin " << name << ' ' << joblink::to_hex(hash) << ' ' << std::fixed << std::setprecision(3)
        << unix_s << '\n'
        << std::flush;
  joblink::JobRun& run = runs_.emplace_back();
  run.set_id(runs_.size());
  run.set_name(name);
  run.set_hash(hash);
  run.set_begun_unix_s(unix_s);
}

void SimulatedGateway::end(joblink::JobResult result, double duration_s) {
  file_ << "end " << result << ' ' << duration_s << '\n' << std::flush;
  runs_.back().set_result(result);
  runs_.back().set_duration_s(duration_s);
  run_until_ = LocalTime::max();
}

void SimulatedGateway::on_time(LocalTime now) {
  if (running() && now >= run_until_) end(joblink::JOB_COMPLETE, to_seconds(job_time_));
}

void SimulatedGateway::status(LocalTime now, joblink::Status& status) const {
  status.set_state(running() ? joblink::STATE_RUNNING : joblink::STATE_READY);
  status.set_state_words(running() ? "running" : "ready");
  if (running()) {
    status.set_job(runs_.back().name());
    status.set_progress(1 - to_seconds(run_until_ - now) / to_seconds(job_time_));
  }
  joblink::CommandStatus& start = *status.add_commands();
  start.set_command(joblink::COMMAND_START_JOB);
  start.set_allowed(!running());
}

void SimulatedGateway::history(const joblink::GetHistory& request, joblink::History& history) const {
  for (std::size_t i = runs_.size(); i-- > 0;) {
    if (request.before_id() != 0 && runs_[i].id() >= request.before_id()) continue;
    if (static_cast<std::uint32_t>(history.runs_size()) >= request.max_runs()) break;
    *history.add_runs() = runs_[i];
  }
}

void SimulatedGateway::upload(const joblink::UploadBegin& begin, joblink::UploadState& state) {
  open_ = begin;
  const auto stored = stored_.find(begin.name());
  state.set_upload_id(1);
  state.set_stored(stored != stored_.end() && stored->second == begin.hash());
  if (state.stored()) state.set_received_bytes(begin.size_bytes());
}

void SimulatedGateway::start(LocalTime now, const std::string& name, joblink::Reply& reply) {
  const auto job = stored_.find(name);
  if (job == stored_.end()) {
    reply = refused(joblink::ERROR_NO_SUCH_JOB, "no such job");
    return;
  }
  const bool before =
      std::any_of(runs_.begin(), runs_.end(), [&](const auto& run) { return run.name() == name; });
  if (before || running()) {
    // A machine that is busy keeps of what it refuses no more than its real self: here nobody else starts
    // jobs.
    reply = refused(joblink::ERROR_NAME, before ? "was started before" : "is busy");
    return;
  }
  begin(name, job->second, unix_now());
  run_until_ = now + job_time_;
}

joblink::Reply SimulatedGateway::answer(LocalTime now, const joblink::ClientMessage& request) {
  on_time(now);
  joblink::Reply reply;
  using Request = joblink::ClientMessage;
  switch (request.request_case()) {
    case Request::kGetStatus:
      status(now, *reply.mutable_status());
      break;
    case Request::kGetHistory:
      history(request.get_history(), *reply.mutable_history());
      break;
    case Request::kUploadBegin:
      upload(request.upload_begin(), *reply.mutable_upload());
      break;
    case Request::kUploadCommit:
      stored_[open_.name()] = open_.hash();
      reply.mutable_upload()->set_upload_id(1);
      reply.mutable_upload()->set_received_bytes(open_.size_bytes());
      reply.mutable_upload()->set_stored(true);
      break;
    case Request::kStartJob:
      start(now, request.start_job().name(), reply);
      break;
    case Request::kDeleteJob:
      stored_.erase(request.delete_job().name());
      break;
    case Request::kCancel:
      if (running()) end(joblink::JOB_CANCELLED, 0.1);
      break;
    case Request::kPing:
    case Request::kWatch:
    case Request::kReleaseControl:
      break;
    default:
      reply = refused(joblink::ERROR_NOT_UNDERSTOOD, "a simulated gateway does not know the request");
  }
  return reply;
}

}  // namespace kinebus::fleet
