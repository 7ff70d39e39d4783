#include "gateway/io/users_file.hpp"

#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/io/job_link_host.hpp"
#include "gateway/io/tls_stream.hpp"

namespace kinebus {
namespace {
/// 32 characters: OctoPrint's clients take 32 to 43.
constexpr std::size_t kHttpKeyBytes = 16;
/// An editor that moves the old file away and writes a new one is done by then.
constexpr LocalTime kSettled = std::chrono::milliseconds{200};

/// Of a folder; a file that is being written tells when it is closed.
constexpr std::uint32_t kChanges = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_ATTRIB;
}  // namespace

UsersFile::UsersFile(EventLoop& loop, Worker& worker, Files files)
    : loop_(loop), worker_(worker), files_(std::move(files)) {}

UsersFile::~UsersFile() {
  if (changes_ < 0) return;
  loop_.forget(changes_);
  ::close(changes_);
}

Result<http::Users, std::string> UsersFile::read(const Files& files) {
  using Wrong = Error<std::string>;
  auto key = token_of(files.key, kHttpKeyBytes);
  if (!key) return Wrong(key.error());
  std::error_code unreadable;
  if (!files.must_be_there && !std::filesystem::exists(files.users, unreadable) && !unreadable)
    return http::Users(std::move(*key));
  if (std::string loose = loose_secret(files.users); !loose.empty()) return Wrong(std::move(loose));
  std::ifstream in(files.users);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Wrong(files.users.string() + " cannot be read");
  auto users = http::Users::read(std::move(*key), text.str());
  if (!users) return Wrong(files.users.string() + ", " + users.error());
  return users;
}

void UsersFile::keep(http::Server& server, volatile std::sig_atomic_t* asked) {
  server_ = &server;
  asked_ = asked;
  changes_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (changes_ >= 0) loop_.watch(changes_, EPOLLIN, [this](std::uint32_t) { on_changes(); });
  watch(files_.users);
  if (files_.key.parent_path() != files_.users.parent_path()) watch(files_.key);
}

void UsersFile::watch(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (changes_ < 0 || ::inotify_add_watch(changes_, folder.c_str(), kChanges) < 0)
    spdlog::warn("changes of {} are taken up when kinebusd is reloaded (SIGHUP), not before: {}: {}",
                 file.string(), folder.string(), std::strerror(errno));
}

void UsersFile::on_changes() {
  alignas(inotify_event) std::array<char, 4096> bytes{};
  for (;;) {
    const ssize_t size = ::read(changes_, bytes.data(), bytes.size());
    if (size <= 0) return;
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event change{};
      std::memcpy(&change, bytes.data() + at, sizeof change);
      const std::string_view name =
          change.len > 0 ? std::string_view(bytes.data() + at + sizeof change) : std::string_view();
      // What was lost may have been one of them.
      if (name == files_.users.filename() || name == files_.key.filename() ||
          (change.mask & IN_Q_OVERFLOW) != 0)
        due_ = loop_.now() + kSettled;
      at += sizeof change + change.len;
    }
  }
}

void UsersFile::on_time(LocalTime now) {
  if (server_ == nullptr) return;
  if (*asked_ != 0) {
    *asked_ = 0;
    due_ = now;
  }
  if (reading_ || now < due_) return;
  due_ = LocalTime::max();
  reading_ = true;
  worker_.ask([files = files_] { return read(files); },
              [this](Result<http::Users, std::string> users) { take(std::move(users)); });
}

void UsersFile::take(Result<http::Users, std::string> users) {
  reading_ = false;
  if (!users) return spdlog::error("users of HTTP stay as they were: {}", users.error());
  const std::size_t count = users->all().size();
  const std::size_t put_out = server_->take_users(loop_.now(), std::move(*users));
  // One of them is the holder of the gateway's key.
  spdlog::info("users of HTTP read anew: {} beside the gateway's key, {} connections put out", count - 1,
               put_out);
}

}  // namespace kinebus
