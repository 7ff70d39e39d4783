#include "gateway/io/worker_thread.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>

#include "protocol/host/quiet_thread.hpp"

namespace kinebus {

WorkerThread::WorkerThread(EventLoop& loop) : loop_(loop), event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (event_ < 0) throw std::system_error(errno, std::generic_category(), "worker thread");
  loop_.watch(event_, EPOLLIN, [this](std::uint32_t) { take_done(); });
  thread_ = quiet_thread([this] { run(); });
}

WorkerThread::~WorkerThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.wake();
  thread_.join();
  loop_.forget(event_);
  ::close(event_);
}

void WorkerThread::post(std::function<void()> work, std::function<void()> done) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(work), std::move(done)});
  }
  wake_.wake();
}

void WorkerThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    while (!ends_ && waiting_.empty()) {
      lock.unlock();
      wake_.wait();
      lock.lock();
    }
    if (waiting_.empty()) return;
    Piece piece = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    piece.work();
    // Destroyed here: what the work holds may be large, or a file.
    piece.work = nullptr;
    lock.lock();
    done_.push_back(std::move(piece.done));
    lock.unlock();
    wake_loop();
    lock.lock();
  }
}

void WorkerThread::wake_loop() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(event_, &one, sizeof one);
}

void WorkerThread::take_done() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t size = ::read(event_, &count, sizeof count);
  {
    const std::lock_guard lock(mutex_);
    for (auto& call : done_) told_.push_back(std::move(call));
    done_.clear();
  }
  // Each may cost as much as a request; the others come back in the next turn.
  for (bool first = true; !told_.empty(); first = false) {
    if (gate_ != nullptr && (!first || !gate_->begins())) return wake_loop();
    const auto call = std::move(told_.front());
    told_.pop_front();
    call();
    if (gate_ != nullptr) gate_->ends();
  }
}

}  // namespace kinebus
