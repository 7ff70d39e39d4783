// kinebus-can-relay: joins two CAN interfaces as a wire with faults would. Frames of the first interface go
// to the second one delayed, in another order, with a wrong bit, or as they are; the other way always as they
// are.
//   kinebus-can-relay FROM TO FAULT ID[,ID...] [FAULT ID...]
// begins without a fault; each SIGUSR1 goes on to the next of them, after the last to none.
//   delay    each frame later by up to 8 ms, in order
//   shuffle  every four frames, or those of 20 ms, in any order
//   flip     one bit of every fourth frame is wrong
//   drop     every third frame is lost

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <deque>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/realtime.hpp"
#include "protocol/host/socketcan.hpp"

namespace {

using namespace std::chrono_literals;
using kinebus::CanFrame;
using kinebus::LocalTime;
using kinebus::SocketCan;

struct Fault {
  std::string_view kind = "none";
  std::vector<std::uint32_t> ids;
  bool strikes(const CanFrame& frame) const {
    return std::find(ids.begin(), ids.end(), frame.id) != ids.end();
  }
};

class Relay {
 public:
  explicit Relay(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  std::string open(const std::string& from, const std::string& to) {
    if (std::string error = from_.open(from, false); !error.empty()) return error;
    return to_.open(to, false);
  }

  void run() {
    sigset_t mask;
    sigemptyset(&mask);
    sigaddset(&mask, SIGUSR1);
    sigprocmask(SIG_BLOCK, &mask, nullptr);
    const int signals = ::signalfd(-1, &mask, SFD_CLOEXEC | SFD_NONBLOCK);
    for (;;) {
      pollfd fds[] = {{from_.fd(), POLLIN, 0}, {to_.fd(), POLLIN, 0}, {signals, POLLIN, 0}};
      const LocalTime due = std::min(late_.empty() ? LocalTime::max() : late_.front().due, shuffle_due_);
      const LocalTime wait = due == LocalTime::max() ? 1s : due - kinebus::monotonic_now();
      const timespec limit{0, std::clamp<long>(static_cast<long>(wait.count()), 0, 999'999'999)};
      if (::ppoll(fds, 3, &limit, nullptr) < 0) continue;
      signalfd_siginfo info{};
      while (::read(signals, &info, sizeof info) == sizeof info) next_fault();
      while (const auto got = to_.receive())
        if (got->kind == SocketCan::Kind::kFrame) send(from_, got->frame);
      while (const auto got = from_.receive())
        if (got->kind == SocketCan::Kind::kFrame) pass(got->frame);
      while (!late_.empty() && late_.front().due <= kinebus::monotonic_now()) release();
      if (shuffle_due_ <= kinebus::monotonic_now()) release_shuffled();
    }
  }

 private:
  struct Late {
    LocalTime due{0};
    CanFrame frame;
  };

  static void send(SocketCan& socket, const CanFrame& frame) {
    while (socket.send(frame) == SocketCan::Sent::kFull) ::usleep(100);
  }
  void release() {
    send(to_, late_.front().frame);
    late_.pop_front();
  }
  void release_shuffled() {
    std::shuffle(kept_.begin(), kept_.end(), random_);
    for (const CanFrame& frame : kept_) send(to_, frame);
    kept_.clear();
    shuffle_due_ = LocalTime::max();
  }
  void next_fault() {
    while (!late_.empty()) release();
    release_shuffled();
    place_ = std::min(place_ + 1, faults_.size() + 1);
    std::printf("relay: %s; %u frames struck so far\n", std::string(fault().kind).c_str(), struck_);
    std::fflush(stdout);
  }
  const Fault& fault() const {
    static const Fault none;
    return place_ == 0 || place_ > faults_.size() ? none : faults_[place_ - 1];
  }

  void pass(CanFrame frame) {
    if (!fault().strikes(frame)) return send(to_, frame);
    ++seen_;
    if (fault().kind == "delay") {
      const LocalTime due =
          kinebus::monotonic_now() + LocalTime{static_cast<std::int64_t>(random_() % 8'000'000)};
      late_.push_back({late_.empty() ? due : std::max(due, late_.back().due), frame});
      ++struck_;
    } else if (fault().kind == "shuffle") {
      if (kept_.empty()) shuffle_due_ = kinebus::monotonic_now() + 20ms;
      kept_.push_back(frame);
      ++struck_;
      if (kept_.size() == 4) release_shuffled();
    } else if (fault().kind == "drop" && seen_ % 3 == 0) {
      ++struck_;
    } else {
      if (fault().kind == "flip" && seen_ % 4 == 0 && frame.length > 0) {
        std::uint8_t& byte = frame.data[random_() % frame.length];
        byte = static_cast<std::uint8_t>(byte ^ (1u << (random_() % 8)));
        ++struck_;
      }
      send(to_, frame);
    }
  }

  std::vector<Fault> faults_;
  SocketCan from_, to_;
  std::size_t place_ = 0;
  std::deque<Late> late_;
  std::vector<CanFrame> kept_;
  LocalTime shuffle_due_ = LocalTime::max();
  std::mt19937_64 random_{1};
  unsigned seen_ = 0, struck_ = 0;
};

int run(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr, "kinebus-can-relay FROM TO [FAULT ID[,ID...]]...\n");
    return 2;
  }
  std::vector<Fault> faults;
  for (int i = 3; i + 1 < argc; i += 2) {
    Fault fault{.kind = argv[i], .ids = {}};
    const std::string ids = argv[i + 1];
    for (std::size_t at = 0; at < ids.size();) {
      std::size_t used = 0;
      fault.ids.push_back(static_cast<std::uint32_t>(std::stoul(ids.substr(at), &used, 16)));
      at += used + 1;
    }
    faults.push_back(std::move(fault));
  }
  Relay relay(std::move(faults));
  if (const std::string error = relay.open(argv[1], argv[2]); !error.empty()) {
    std::fprintf(stderr, "kinebus-can-relay: %s\n", error.c_str());
    return 1;
  }
  static_cast<void>(kinebus::become_realtime(88));
  relay.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-can-relay", [&] { return run(argc, argv); });
}
