#include "gateway/io/journal_file.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "gateway/jobs/journal/journal_codec.hpp"
#include "gateway/machine/gateway.hpp"
#include "protocol/host/inheriting_mutex.hpp"
#include "protocol/host/quiet_thread.hpp"
#include "protocol/host/wake_up.hpp"
#include "protocol/host/write_all.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Reserved at the start, so that a disk that fills up later does not stop the journal.
constexpr off_t kReserved = 512 << 10;
/// Longer than this the file is written anew with what still counts.
constexpr std::size_t kLongest = 256 << 10;
/// The place in motion goes to the disk itself so often; everything else at once.
constexpr auto kSyncPeriod = 1s;
/// A disk that refused is tried again.
constexpr auto kRetry = 2s;
constexpr LocalTime kLookForStored = 1ms;

}  // namespace

class JournalFile::Writer {
 public:
  Writer(std::filesystem::path path, const journal::State& state) : path_(std::move(path)), state_(state) {
    // The first file before anything moves; the rest beside the loop.
    if (!begin_file()) problem_ = problem_words();
    thread_ = quiet_thread([this] { work(); });
  }
  ~Writer() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.wake();
    thread_.join();
    if (fd_ >= 0) ::close(fd_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void hand(journal::Record record) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(record));
    }
    wake_.wake();
  }
  std::uint64_t stored() const { return stored_.load(std::memory_order_acquire); }
  std::optional<std::string> take_problem() {
    const std::lock_guard lock(mutex_);
    return std::exchange(problem_, std::nullopt);
  }

 private:
  std::string problem_words() const {
    return path_.string() + ": " + std::strerror(errno) +
           ": an interrupted job could not be resumed after a restart";
  }

  /// A whole new file takes the old one's place, or the old one stays.
  bool begin_file() {
    const std::filesystem::path fresh = path_.string() + ".new";
    const int fd = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0640);
    if (fd < 0) return false;
    static_cast<void>(::fallocate(fd, FALLOC_FL_KEEP_SIZE, 0, kReserved));
    std::vector<std::uint8_t> bytes;
    std::uint32_t number = 0;
    for (const journal::Record& record : state_.records()) journal::encode(record, number++, bytes);
    if (!write_all(fd, bytes) || ::fdatasync(fd) != 0 || ::rename(fresh.c_str(), path_.c_str()) != 0) {
      const int error = errno;
      ::close(fd);
      ::unlink(fresh.c_str());
      errno = error;
      return false;
    }
    const int folder = ::open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      ::fsync(folder);
      ::close(folder);
    }
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
    number_ = number;
    length_ = bytes.size();
    return true;
  }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (!ends_ && waiting_.empty()) {
        lock.unlock();
        wake_.wait(dirty_ || fd_ < 0 ? kSyncPeriod : 3600s);
        lock.lock();
      }
      std::deque<journal::Record> batch = std::exchange(waiting_, {});
      const bool ends = ends_;
      lock.unlock();
      const bool good = store(batch);
      const std::string words = good ? std::string() : problem_words();
      stored_.fetch_add(batch.size(), std::memory_order_release);
      lock.lock();
      if (!good && !std::exchange(told_, true)) problem_ = words;
      if (good) told_ = false;
      if (ends && waiting_.empty()) return;
    }
  }

  bool store(const std::deque<journal::Record>& batch) {
    std::vector<std::uint8_t> bytes;
    bool urgent = false;
    std::uint32_t number = number_;
    for (const journal::Record& record : batch) {
      state_.take(record);
      urgent = urgent || !(std::holds_alternative<journal::Progress>(record) ||
                           std::holds_alternative<journal::JobTime>(record));
      journal::encode(record, number++, bytes);
    }
    const auto now = std::chrono::steady_clock::now();
    if (fd_ < 0) {
      if (now - tried_ < kRetry && !urgent) return false;
      tried_ = now;
      return begin_file();
    }
    if (length_ + bytes.size() > kLongest && begin_file()) return true;
    if (!write_all(fd_, bytes)) {
      // What was begun cannot be read any more: only a new file helps.
      const int error = errno;
      ::close(std::exchange(fd_, -1));
      errno = error;
      return begin_file();
    }
    number_ = number;
    length_ += bytes.size();
    dirty_ = dirty_ || !bytes.empty();
    if (!dirty_ || (!urgent && now - synced_ < kSyncPeriod)) return true;
    synced_ = now;
    dirty_ = false;
    return ::fdatasync(fd_) == 0;
  }

  std::filesystem::path path_;
  journal::State state_;
  int fd_ = -1;
  std::uint32_t number_ = 0;
  std::size_t length_ = 0;
  bool dirty_ = false, told_ = false;
  std::chrono::steady_clock::time_point synced_{}, tried_{};
  std::atomic<std::uint64_t> stored_{0};

  InheritingMutex mutex_;
  WakeUp wake_;
  std::deque<journal::Record> waiting_;
  std::optional<std::string> problem_;
  bool ends_ = false;
  std::thread thread_;
};

journal::State JournalFile::read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return journal::decode(bytes).state;
}

JournalFile::JournalFile(std::filesystem::path path, const journal::State& state, Gateway& gateway)
    : gateway_(gateway), writer_(std::make_unique<Writer>(std::move(path), state)) {}

JournalFile::~JournalFile() = default;

void JournalFile::on_time(LocalTime now) {
  now_ = now;
  while (auto record = gateway_.next_journal_record()) {
    writer_->hand(std::move(*record));
    ++handed_;
  }
  if (const auto problem = writer_->take_problem()) spdlog::warn("{}", *problem);
  const std::uint64_t stored = writer_->stored();
  gateway_.on_journal_stored(stored);
  waiting_ = stored < handed_;
}

LocalTime JournalFile::next_deadline() const {
  return waiting_ ? now_ + kLookForStored : LocalTime::max();
}

}  // namespace kinebus
