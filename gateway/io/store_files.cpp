#include "gateway/io/store_files.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>

#include "gateway/jobs/store/upload_file.hpp"
#include "protocol/host/write_all.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;

// The one file on its way to the disk: no job's name begins so.
constexpr const char* kWritten = ".serial";

Result<void, StoreError> write_file(const fs::path& path, std::string_view text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (fd < 0) return Error<StoreError>(disk_error(path, errno));
  if (!write_all(fd, text)) {
    const StoreError error = disk_error(path, errno);
    ::close(fd);
    ::unlink(path.c_str());
    return Error<StoreError>(error);
  }
  ::close(fd);
  return {};
}

void finish(const SerialFiles::Asked& answer, const Result<void, StoreError>& done) {
  if (!done) answer->refused = done.error().words.english();
  answer->done = true;
}

}  // namespace

StoreFiles::StoreFiles(JobStore& store, Worker& worker, Gateway& gateway, JobLinkServer& server)
    : store_(store), worker_(worker), gateway_(gateway), server_(server) {
  // What a power cut left half written.
  std::error_code error;
  fs::remove(store_.folder() / kWritten, error);
}

void StoreFiles::list(const Asked& answer) {
  worker_.ask(
      [&store = store_] {
        Answer found;
        std::string after;
        for (bool more = true; more;) {
          const auto part = store.list(after);
          if (!part) {
            found.refused = part.error().words.english();
            break;
          }
          for (const StoredJob& job : part->jobs) found.entries.push_back({job.name, job.size_bytes});
          more = part->more && !part->jobs.empty();
          if (more) after = part->jobs.back().name;
        }
        return found;
      },
      [answer](Answer found) {
        *answer = std::move(found);
        answer->done = true;
      });
}

void StoreFiles::size(const Asked& answer, std::string_view name) {
  using Size = Result<std::uint64_t, StoreError>;
  worker_.ask(
      [&store = store_, name = std::string(name)]() -> Size {
        const auto job = store.open_job(name);
        if (!job) return Error<StoreError>(job.error());
        return (*job)->size().value_or(0);
      },
      [answer, name = std::string(name)](const Size& size) {
        if (!size)
          answer->refused = size.error().words.english();
        else
          answer->entries.push_back({name, *size});
        answer->done = true;
      });
}

void StoreFiles::run(const Asked& asker, std::string_view name) {
  worker_.ask(
      [&store = store_, name = std::string(name), unix_s = static_cast<double>(std::time(nullptr))] {
        return store.begin_job(name, unix_s);
      },
      [this, asked = std::weak_ptr(asker), name = std::string(name)](Result<BegunJob, StoreError> job) {
        const Asked answer = asked.lock();
        if (!job) {
          if (answer) answer->refused = job.error().words.english();
        } else if (!answer) {
          // Nobody waits for it any more: M410, M112, a pulled cable.
          server_.job_refused(name, job->run, say("nobody waits for it any more"));
        } else if (const auto begun = gateway_.carry_out(command::Run{std::move(job->text), name}); !begun) {
          server_.job_refused(name, job->run, begun.error().words);
          answer->refused = begun.error().words.english();
        } else {
          server_.job_started(name, job->run);
        }
        if (answer) answer->done = true;
      });
}

void StoreFiles::remove(const Asked& answer, std::string_view name) {
  worker_.ask([&store = store_, name = std::string(name)] { return store.remove(name); },
              [answer](const Result<void, StoreError>& removed) { finish(answer, removed); });
}

void StoreFiles::store(const Asked& answer, std::string_view name, std::string text) {
  worker_.ask(
      [&store = store_, name = std::string(name), text = std::move(text),
       unix_s = static_cast<double>(std::time(nullptr))]() -> Result<void, StoreError> {
        if (Sentence broken = JobStore::check_name(name); !broken.empty())
          return Error<StoreError>({StoreError::Kind::kName, broken});
        const fs::path written = store.folder() / kWritten;
        if (auto there = write_file(written, text); !there) return there;
        return store.adopt(written, name, unix_s);
      },
      [answer](const Result<void, StoreError>& stored) { finish(answer, stored); });
}

}  // namespace kinebus
