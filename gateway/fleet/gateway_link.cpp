#include "gateway/fleet/gateway_link.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "tools/cli/requests.hpp"

namespace kinebus::fleet {
namespace {

using joblink::ClientMessage;
constexpr std::uint32_t kRunsAsked = 50;
/// No such G code: the whole job is checked before anything moves, so nothing of it does.
constexpr const char* kUsedUp = "; taken back by the fleet: this ticket is used up\nG999999\n";

bool allowed(const joblink::Status& status, joblink::Command command) {
  for (const joblink::CommandStatus& c : status.commands())
    if (c.command() == command) return c.allowed();
  return false;
}

Result result_of(joblink::JobResult result) {
  switch (result) {
    case joblink::JOB_COMPLETE:
      return Result::kComplete;
    case joblink::JOB_CANCELLED:
      return Result::kCancelled;
    case joblink::JOB_REFUSED:
      return Result::kRefused;
    case joblink::JOB_INTERRUPTED:
      return Result::kInterrupted;
    default:
      return Result::kFailed;
  }
}

/// A text as a file, as long as it is sent.
class SentFile {
 public:
  explicit SentFile(const std::string& text) {
    std::string path = (std::filesystem::temp_directory_path() / "kinebus-fleet-XXXXXX").string();
    const int fd = ::mkstemp(path.data());
    if (fd < 0) throw ClientError(path + " cannot be made");
    ::close(fd);
    path_ = path;
    std::ofstream out(path_, std::ios::binary);
    out << text << std::flush;
    if (!out) {
      remove();
      throw ClientError(path_ + " cannot be written");
    }
  }
  ~SentFile() { remove(); }
  SentFile(const SentFile&) = delete;
  SentFile& operator=(const SentFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  void remove() const {
    std::error_code error;
    std::filesystem::remove(path_, error);
  }
  std::string path_;
};

}  // namespace

GatewayFacts GatewayLink::look(const std::optional<QueuedJob>& job) {
  GatewayFacts facts;
  // The history before the status: a run that is seen as ended is not shown with the status from before its
  // end.
  if (job) facts.run = find_run(*job, facts.history_is_short);
  const joblink::Status status = client_.status();
  facts.state = status.state_words();
  facts.progress = status.progress();
  facts.job = status.job();
  facts.interrupted = status.interrupted();
  facts.takes_job = allowed(status, joblink::COMMAND_START_JOB);
  facts.can_home = (status.state() == joblink::STATE_OFF && allowed(status, joblink::COMMAND_BRING_UP)) ||
                   (status.state() == joblink::STATE_UNHOMED && allowed(status, joblink::COMMAND_HOME));
  if (!job && facts.takes_job) {
    ClientMessage request;
    request.mutable_get_history()->set_max_runs(1);
    const joblink::Reply reply = client_.ask(std::move(request));
    if (reply.history().runs_size() > 0) facts.newest_run = reply.history().runs(0).id();
  }
  return facts;
}

std::optional<TicketRun> GatewayLink::find_run(const QueuedJob& job, bool& short_history) {
  const std::string ticket = ticket_of(job);
  std::uint64_t before = 0;
  for (;;) {
    ClientMessage request;
    request.mutable_get_history()->set_before_id(before);
    request.mutable_get_history()->set_max_runs(kRunsAsked);
    const joblink::Reply reply = client_.ask(std::move(request));
    for (const joblink::JobRun& run : reply.history().runs()) {
      before = run.id();
      if (run.name() == ticket)
        return TicketRun{.text_hash = run.hash(),
                         .ended = run.result() != joblink::JOB_RUNNING,
                         .result = result_of(run.result()),
                         .duration_s = run.duration_s(),
                         .words = run.first_error()};
      if (run.id() <= job.after_run) return std::nullopt;
    }
    // Fewer than asked for may have had place in one message.
    if (reply.history().runs_size() == 0) break;
  }
  short_history = job.after_run > 0;
  return std::nullopt;
}

joblink::Reply GatewayLink::command(ClientMessage message) {
  joblink::Reply reply = client_.ask(std::move(message));
  client_.release_control();  // people may command the machine, too
  return reply;
}

void GatewayLink::start(const QueuedJob& job, const std::string& text) {
  const SentFile file(text);
  client_.upload(file.path(), ticket_of(job), [](std::uint64_t, std::uint64_t) {});
  ClientMessage request;
  request.mutable_start_job()->set_name(ticket_of(job));
  command(std::move(request));
}

void GatewayLink::use_up(const QueuedJob& job) {
  start(job, kUsedUp);
}

void GatewayLink::cancel() {
  command(plain(&ClientMessage::mutable_cancel));
}

void GatewayLink::home() {
  command(client_.status().state() == joblink::STATE_OFF ? plain(&ClientMessage::mutable_bring_up)
                                                         : plain(&ClientMessage::mutable_home));
}

void GatewayLink::forget(const QueuedJob& job) {
  ClientMessage request;
  request.mutable_delete_job()->set_name(ticket_of(job));
  static_cast<void>(client_.try_ask(std::move(request)));
}

}  // namespace kinebus::fleet
