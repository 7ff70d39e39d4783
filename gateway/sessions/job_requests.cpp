#include "gateway/sessions/job_requests.hpp"

#include <algorithm>
#include <utility>

#include "gateway/run/bed_level.hpp"
#include "gateway/sessions/job_check_task.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/frame_codec.hpp"
#include "protocol/joblink/sha256.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using joblink::Reply;

constexpr std::size_t kMaxRead = 512U << 10;
constexpr std::size_t kMaxMachineFile = 512U << 10;
constexpr std::size_t kMaxChecks = 8;

Reply upload_reply(const UploadProgress& progress) {
  Reply reply;
  reply.mutable_upload()->set_upload_id(progress.id);
  reply.mutable_upload()->set_received_bytes(progress.received_bytes);
  reply.mutable_upload()->set_stored(progress.stored);
  return reply;
}

template <typename T>
Reply error_reply(const Result<T, StoreError>& result) {
  Reply reply;
  *reply.mutable_error() = problem(result.error());
  return reply;
}

joblink::Event jobs_changed(const std::string& name) {
  joblink::Event event;
  event.set_kind(joblink::EVENT_JOBS);
  event.set_job(name);
  return event;
}

}  // namespace

bool JobRequests::take(const Asker& asker, const ClientMessage& message) {
  switch (message.request_case()) {
    case ClientMessage::kUploadBegin:
      begin_upload(asker, message.upload_begin());
      return true;
    case ClientMessage::kUploadChunk:
      chunk(asker, {.head = {.request_id = message.request_id(),
                             .upload_id = message.upload_chunk().upload_id(),
                             .offset_bytes = message.upload_chunk().offset_bytes()},
                    .data = message.upload_chunk().data()});
      return true;
    case ClientMessage::kUploadCommit:
      commit(asker, message.upload_commit());
      return true;
    case ClientMessage::kUploadAbort:
      abort(asker, message.upload_abort());
      return true;
    case ClientMessage::kDiscardUpload:
      discard(asker, message.discard_upload());
      return true;
    case ClientMessage::kListJobs:
      list(asker, message.list_jobs().after_name());
      return true;
    case ClientMessage::kDeleteJob:
      remove(asker, message.delete_job().name());
      return true;
    case ClientMessage::kReadJob:
      read(asker, message.read_job());
      return true;
    case ClientMessage::kCheckJob:
      check(asker, message.check_job().name());
      return true;
    case ClientMessage::kGetHistory:
      history(asker, message.get_history());
      return true;
    case ClientMessage::kReadMachineFile:
      read_machine_file(asker);
      return true;
    case ClientMessage::kCheckMachineFile:
      check_machine_file(asker, message.check_machine_file().text());
      return true;
    case ClientMessage::kRestartGateway:
      restart(asker);
      return true;
    case ClientMessage::kWriteMachineFile:
      write_machine_file(asker, message.write_machine_file());
      return true;
    default:
      return false;
  }
}

template <typename Begin>
void JobRequests::begin(const Asker& asker, Begin begin) {
  server_.worker_.ask(
      std::move(begin), [&server = server_, asker](const Result<UploadProgress, StoreError>& begun) {
        Requester* requester = server.find(asker.session);
        if (begun && begun->id != 0) {
          // Who has gone meanwhile leaves nothing open.
          if (requester != nullptr && requester->client() != 0)
            requester->begin_upload(begun->id);
          else
            server.worker_.post([&store = server.store_, id = begun->id] { store.abort(id, false); }, [] {});
        }
        server.answer(asker, begun ? upload_reply(*begun) : error_reply(begun));
      });
}

void JobRequests::begin_upload(const Asker& asker, const joblink::UploadBegin& request) {
  UploadIdentity identity{request.name(), request.size_bytes(), request.hash()};
  begin(asker, [&store = server_.store_, identity = std::move(identity), replace = request.replace(),
                unix_s = server_.unix_s(now_)] { return store.begin_upload(identity, replace, unix_s); });
}

void JobRequests::begin_open_ended(const Asker& asker, const std::string& name, std::uint64_t expected_bytes,
                                   bool replace) {
  begin(asker, [&store = server_.store_, name, expected_bytes, replace, unix_s = server_.unix_s(now_)] {
    return store.begin_open_ended(name, expected_bytes, replace, unix_s);
  });
}

void JobRequests::chunk(const Asker& asker, const joblink::ChunkView& chunk) {
  if (!requester_.owns_upload(chunk.head.upload_id)) return refuse_upload(asker);
  const std::size_t size = chunk.data.size();
  requester_.owe(size);
  auto data = std::make_shared<std::string>(requester_.spare_buffer());
  data->assign(chunk.data);
  server_.worker_.ask(
      [&store = server_.store_, head = chunk.head, data] {
        return store.append(head.upload_id, head.offset_bytes, *data);
      },
      [&server = server_, asker, size, data](const Result<UploadProgress, StoreError>& taken) {
        server.answer(asker, taken ? upload_reply(*taken) : error_reply(taken));
        Requester* requester = server.find(asker.session);
        if (requester == nullptr) return;
        requester->keep_buffer(std::move(*data));
        requester->paid(size);
      });
}

void JobRequests::commit(const Asker& asker, const joblink::UploadCommit& request) {
  if (!requester_.owns_upload(request.upload_id())) return refuse_upload(asker);
  server_.worker_.ask([&store = server_.store_, id = request.upload_id(),
                       unix_s = server_.unix_s(now_)] { return store.commit(id, unix_s); },
                      [&server = server_, asker, id = request.upload_id(),
                       now = now_](const Result<UploadProgress, StoreError>& done) {
                        Requester* requester = server.find(asker.session);
                        // What came too early is still open.
                        if (requester != nullptr && (done || done.error().kind != StoreError::Kind::kOrder))
                          requester->end_upload(id);
                        server.answer(asker, done ? upload_reply(*done) : error_reply(done));
                        if (done) server.tell(now, jobs_changed({}));
                      });
}

void JobRequests::abort(const Asker& asker, const joblink::UploadAbort& request) {
  if (!requester_.owns_upload(request.upload_id())) return refuse_upload(asker);
  requester_.end_upload(request.upload_id());
  server_.worker_.post([&store = server_.store_, id = request.upload_id(),
                        discard = request.discard()] { store.abort(id, discard); },
                       [&server = server_, asker] { server.answer(asker, {}); });
}

/// Of another session, or none.
void JobRequests::refuse_upload(const Asker& asker) {
  server_.refuse(asker, problem(joblink::ERROR_BAD_VALUE, {},
                                say("this upload is not open: begin it again, it goes on where it was")));
}

void JobRequests::discard(const Asker& asker, const joblink::DiscardUpload& request) {
  UploadIdentity identity{request.name(), request.size_bytes(), request.hash()};
  server_.worker_.ask(
      [&store = server_.store_, identity = std::move(identity)] { return store.discard(identity); },
      [&server = server_, asker, now = now_](const Result<void, StoreError>& discarded) {
        server.answer(asker, discarded ? Reply() : error_reply(discarded));
        if (discarded) server.tell(now, jobs_changed({}));
      });
}

void JobRequests::list(const Asker& asker, const std::string& after) {
  // Made into a message beside the loop, too.
  server_.worker_.ask(
      [&store = server_.store_, after] {
        Reply reply;
        if (const auto listing = store.list(after); !listing)
          reply = error_reply(listing);
        else
          *reply.mutable_jobs() = to_message(*listing);
        return reply;
      },
      [&server = server_, asker](Reply reply) { server.answer(asker, std::move(reply)); });
}

void JobRequests::remove(const Asker& asker, const std::string& name) {
  if (server_.gateway_.status().job == name)
    return server_.refuse(asker, problem(joblink::ERROR_JOB_IN_USE, name, say("this job is running")));
  server_.worker_.ask([&store = server_.store_, name] { return store.remove(name); },
                      [&server = server_, asker, name, now = now_](const Result<void, StoreError>& removed) {
                        server.answer(asker, removed ? Reply() : error_reply(removed));
                        if (removed) server.tell(now, jobs_changed(name));
                      });
}

void JobRequests::read(const Asker& asker, const joblink::ReadJob& request) {
  struct Read {
    Result<std::string, StoreError> text;
    std::uint64_t size = 0;
  };
  const std::size_t max = std::min<std::size_t>(request.max_bytes(), kMaxRead);
  server_.worker_.ask(
      [&store = server_.store_, name = request.name(), offset = request.offset_bytes(), max] {
        Read read{store.read(name, offset, max), 0};
        if (const auto job = store.find(name)) read.size = job->size_bytes;
        return read;
      },
      [&server = server_, asker, offset = request.offset_bytes()](Read read) {
        if (!read.text) return server.answer(asker, error_reply(read.text));
        Reply reply;
        reply.mutable_job_text()->set_offset_bytes(offset);
        reply.mutable_job_text()->set_size_bytes(read.size);
        reply.mutable_job_text()->set_data(std::move(*read.text));
        server.answer(asker, std::move(reply));
      });
}

void JobRequests::check(const Asker& asker, const std::string& name) {
  if (server_.checks_.size() >= kMaxChecks)
    return server_.refuse(
        asker, problem(joblink::ERROR_BUSY, name, say("too many jobs are being checked: ask again later")));
  auto task = std::make_shared<JobCheckTask>(
      server_.store_, server_.machine_, server_.options_.machine_mark, name, server_.gateway_.work_offsets(),
      server_.gateway_.bed().in_force(), server_.gateway_.hotends_found());
  server_.checks_.push_back(task);
  task->run(
      server_.worker_,
      [&server = server_, name](double progress) {
        joblink::Event event;
        event.set_kind(joblink::EVENT_PREFLIGHT);
        event.set_job(name);
        event.set_progress(progress);
        server.tell(server.latest_, std::move(event));
      },
      [&server = server_, asker,
       task = task.get()](const Result<joblink::PreflightResult, StoreError>& result) {
        Reply reply;
        if (result)
          *reply.mutable_preflight() = *result;
        else
          reply = error_reply(result);
        server.answer(asker, std::move(reply));
        std::erase_if(server.checks_, [&](const auto& t) { return t.get() == task; });
      });
}

void JobRequests::history(const Asker& asker, const joblink::GetHistory& request) {
  const std::size_t max = request.max_runs() == 0 ? 100 : request.max_runs();
  server_.worker_.ask(
      [&store = server_.store_, before = static_cast<std::int64_t>(request.before_id() & INT64_MAX), max] {
        Reply reply;
        const auto runs = store.history(before, max);
        if (!runs) return error_reply(runs);
        joblink::History& history = *reply.mutable_history();
        ListRoom room;
        for (const StoredRun& stored : *runs) {
          auto run = to_message(stored);
          history.set_more(!room.take(run));
          if (history.more()) break;
          history.mutable_runs()->Add(std::move(run));
        }
        return reply;
      },
      [&server = server_, asker](Reply reply) { server.answer(asker, std::move(reply)); });
}

void JobRequests::read_machine_file(const Asker& asker) {
  server_.worker_.ask(
      [&file = server_.machine_file_] { return file.read(); },
      [&server = server_, asker](const Result<MachineFilePort::Text, Sentence>& text) {
        if (!text) return server.refuse(asker, problem(joblink::ERROR_STORAGE, "machine file", text.error()));
        if (!is_utf8(text->text))
          return server.refuse(asker, problem(joblink::ERROR_BAD_VALUE, "machine file",
                                              say("the machine file is no text in UTF-8")));
        Reply reply;
        joblink::MachineFile& file = *reply.mutable_machine_file();
        file.set_text(text->text);
        file.set_path(shown(text->path));
        file.set_sha256(joblink::sha256_of(text->text));
        file.set_writable(text->writable);
        file.set_restart_needed(!text->path.empty() &&
                                joblink::to_hex(file.sha256()) != server.options_.machine_mark);
        server.answer(asker, std::move(reply));
      });
}

void JobRequests::check_machine_file(const Asker& asker, const std::string& text) {
  if (text.size() > kMaxMachineFile)
    return server_.refuse(
        asker, problem(joblink::ERROR_BAD_VALUE, "text", say("a machine file has at most 512 KiB")));
  server_.worker_.ask(
      [text] {
        Reply reply;
        const auto parsed = parse_machine(text, "machine file");
        *reply.mutable_machine_file_check() = to_message(parsed ? MachineFileErrors() : parsed.error());
        return reply;
      },
      [&server = server_, asker](Reply reply) { server.answer(asker, std::move(reply)); });
}

void JobRequests::write_machine_file(const Asker& asker, const joblink::WriteMachineFile& request) {
  if (!server_.control_.may_command(requester_.client())) return server_.refuse(asker, server_.no_control());
  if (request.text().size() > kMaxMachineFile)
    return server_.refuse(
        asker, problem(joblink::ERROR_BAD_VALUE, "text", say("a machine file has at most 512 KiB")));
  struct Written {
    joblink::MachineFileCheck errors;
    Sentence failure;
    bool conflict = false;
  };
  server_.worker_.ask(
      [&file = server_.machine_file_, text = request.text(), expected = request.expected_sha256()] {
        Written written;
        if (const auto parsed = parse_machine(text, "machine file"); !parsed) {
          written.errors = to_message(parsed.error());
          return written;
        }
        if (const auto present = file.read(); !expected.empty() && present)
          written.conflict = joblink::sha256_of(present->text) != expected;
        if (written.conflict) return written;
        if (const auto stored = file.write(text); !stored) written.failure = stored.error();
        return written;
      },
      [&server = server_, asker](const Written& written) {
        if (written.conflict)
          return server.refuse(asker, problem(joblink::ERROR_CONFLICT, "machine file",
                                              say("the file was changed by somebody else: read it again")));
        if (!written.failure.empty())
          return server.refuse(asker, problem(joblink::ERROR_STORAGE, "machine file", written.failure));
        Reply reply;
        *reply.mutable_machine_file_check() = written.errors;
        if (written.errors.problems_size() > 0)
          *reply.mutable_error() = reply.machine_file_check().problems(0);
        server.answer(asker, std::move(reply));
      });
}

void JobRequests::restart(const Asker& asker) {
  if (!server_.control_.may_command(requester_.client())) return server_.refuse(asker, server_.no_control());
  if (!server_.options_.restart)
    return server_.refuse(
        asker, problem(joblink::ERROR_OTHER, {}, say("this gateway cannot be started anew from here")));
  // A file that is wrong would leave no gateway at all.
  server_.worker_.ask(
      [&file = server_.machine_file_] {
        const auto text = file.read();
        joblink::MachineFileCheck errors;
        if (!text) return errors;
        if (const auto parsed = parse_machine(text->text, "machine file"); !parsed)
          errors = to_message(parsed.error());
        return errors;
      },
      [&server = server_, asker](const joblink::MachineFileCheck& errors) {
        if (errors.problems_size() > 0) return server.refuse(asker, errors.problems(0));
        const MachineStatus now = server.gateway_.status();
        if (!at_rest(now.state) || !now.job.empty())
          return server.refuse(
              asker, problem(joblink::ERROR_MACHINE_STATE, {},
                             say("the gateway starts anew when the machine rests and no job is under way or "
                                 "interrupted")));
        server.answer(asker, {});
        server.options_.restart();
      });
}

}  // namespace kinebus
