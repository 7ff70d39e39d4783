#include "gateway/io/flight_recorder.hpp"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "gateway/machine/gateway.hpp"
#include "gateway/recorder/flight_report.hpp"
#include "protocol/host/quiet_thread.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/host/wake_up.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// What follows an alarm belongs to it: the ramp, the rest.
constexpr LocalTime kAftermath = 2s;
/// An alarm that comes again and again is one report.
constexpr LocalTime kBetweenReports = 30s;
constexpr std::size_t kReportsKept = 20;
constexpr LocalTime kLookForWriter = 100ms;

void write_report(const FlightRing& ring, const std::filesystem::path& folder, const std::string& interface,
                  const std::string& cause) {
  const auto unix_s =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  const std::string name = "flight-" + std::to_string(unix_s);
  std::ofstream(folder / (name + ".log")) << flight_log(ring, interface);
  // Who waits for a report finds a whole one.
  const std::filesystem::path part = folder / (name + ".part");
  std::ofstream(part) << flight_json(ring, cause, name + ".log");
  std::error_code error;
  std::filesystem::rename(part, folder / (name + ".json"), error);
  std::vector<std::filesystem::path> reports;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".json") reports.push_back(entry.path());
  std::sort(reports.begin(), reports.end());
  for (std::size_t i = 0; i + kReportsKept < reports.size(); ++i) {
    std::filesystem::remove(reports[i], error);
    std::filesystem::remove(reports[i].replace_extension(".log"), error);
  }
}

/// Writes to every page what is there: the first write to one enters the kernel, and none is to be left to
/// the loop.
void touch(FlightRing& ring) {
  constexpr std::size_t kPage = 4096;
  auto* const bytes = reinterpret_cast<volatile std::uint8_t*>(&ring);
  for (std::size_t at = 0; at < sizeof ring; at += kPage) bytes[at] = bytes[at];
}

}  // namespace

struct FlightRecorder::Impl {
  Impl(Options recorder_options, const Gateway& machine)
      : options(std::move(recorder_options)), gateway(machine) {}

  Options options;
  const Gateway& gateway;
  FlightRing* ring = nullptr;
  std::thread writer;
  WakeUp wake;
  std::function<void()> work;        ///< the writer's while it is writing
  std::atomic<bool> writing{false};  ///< the writer is at work
  std::atomic<bool> ends{false};
  std::atomic<bool> frozen{false};  ///< it copies the ring
  LocalTime next_sample{0}, report_at = LocalTime::max(), last_report{-kBetweenReports};
  std::string cause;

  /// A thread of its own, made before anything moves: a slow disk holds nothing up.
  void start_writer() {
    writer = quiet_thread([this] {
      while (!ends || writing) {
        if (writing) {
          work();
          work = nullptr;
          writing = false;
        } else {
          wake.wait();
        }
      }
    });
  }
  void end_writer() {
    if (!writer.joinable()) return;
    ends = true;
    wake.wake();
    writer.join();
  }
  /// Only while it is not writing.
  void write(std::function<void()> next) {
    work = std::move(next);
    writing = true;
    wake.wake();
  }
  void report_death(std::unique_ptr<FlightRing> died) {
    write([this, died = std::shared_ptr<FlightRing>(std::move(died))] {
      write_report(*died, options.folder, options.interface, "the gateway died");
    });
  }
  void report(std::string why) {
    frozen = true;
    write([this, why = std::move(why)] {
      const auto copy = std::make_unique<FlightRing>(*ring);
      frozen = false;
      write_report(*copy, options.folder, options.interface, why);
    });
  }
};

FlightRecorder::FlightRecorder(Options options, const Gateway& gateway)
    : impl_(std::make_unique<Impl>(std::move(options), gateway)) {}

FlightRecorder::~FlightRecorder() {
  impl_->end_writer();
  if (impl_->ring == nullptr) return;
  impl_->ring->running = 0;
  // What is no file of the reports' folder takes memory: only who died has something to tell.
  if (!impl_->options.memory.empty()) ::unlink(impl_->options.memory.c_str());
  ::munmap(impl_->ring, sizeof(FlightRing));
}

std::string FlightRecorder::open() {
  std::error_code error;
  std::filesystem::create_directories(impl_->options.folder, error);
  const std::filesystem::path path =
      impl_->options.memory.empty() ? impl_->options.folder / "memory" : impl_->options.memory;
  const auto failed = [&] { return path.string() + ": " + std::strerror(errno); };
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640);
  if (fd < 0) return failed();
  // A folder of everybody's may hold a file of somebody else's under this name.
  struct stat found {};
  if (::fstat(fd, &found) != 0 || found.st_uid != ::geteuid() || !S_ISREG(found.st_mode)) {
    ::close(fd);
    return path.string() + ": belongs to somebody else";
  }
  // Reserved, so that a full disk cannot end the process when a page is first written.
  const bool sized = ::posix_fallocate(fd, 0, sizeof(FlightRing)) == 0;
  void* memory =
      sized ? ::mmap(nullptr, sizeof(FlightRing), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) : MAP_FAILED;
  ::close(fd);
  if (memory == MAP_FAILED) return sized ? failed() : path.string() + ": no room on the disk";
  impl_->ring = static_cast<FlightRing*>(memory);
  FlightRing& ring = *impl_->ring;
  touch(ring);
  impl_->start_writer();
  if (ring.magic == FlightRing::kMagic && ring.running != 0) {
    impl_->report_death(std::make_unique<FlightRing>(ring));
    spdlog::warn("the gateway before this one died: kinebus explain reads {}/flight-*.json",
                 impl_->options.folder.string());
  }
  ring.frame_count = ring.sample_count = ring.event_count = 0;
  ring.magic = FlightRing::kMagic;
  ring.running = 1;
  FlightRing::put(ring.machine, impl_->options.machine);
  FlightRing::put(ring.job, "");
  ring.unix_offset_ns =
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count() -
      monotonic_now().count();
  return {};
}

void FlightRecorder::on_frame(LocalTime when, const CanFrame& frame, bool own) {
  if (impl_->ring != nullptr && !impl_->frozen) impl_->ring->add_frame(when, frame, own);
}

void FlightRecorder::on_event(const MachineEvent& event) {
  if (impl_->ring == nullptr) return;
  if (!impl_->frozen) {
    FlightRing::Event& row = impl_->ring->next_event();
    row.when_ns = event.when.count();
    row.kind = static_cast<std::uint8_t>(event.kind);
    row.state = static_cast<std::uint8_t>(event.state);
    row.code = event.code;
    row.node = event.node;
    row.line = event.line;
    FlightRing::put(row.words, event.words);
    FlightRing::put(row.advice, event.advice);
  }
  if (event.kind != MachineEvent::Kind::kAlarm || impl_->report_at != LocalTime::max()) return;
  if (event.when - impl_->last_report < kBetweenReports) return;
  impl_->report_at = event.when + kAftermath;
  impl_->cause = event.words.english();
}

void FlightRecorder::on_time(LocalTime now) {
  if (impl_->ring == nullptr) return;
  if (now >= impl_->report_at && impl_->writing) {
    impl_->report_at = now + kLookForWriter;
  } else if (now >= impl_->report_at) {
    impl_->report_at = LocalTime::max();
    impl_->last_report = now;
    impl_->report(impl_->cause);
  }
  if (now < impl_->next_sample) return;
  impl_->next_sample = now + FlightRing::kSamplePeriod;
  if (impl_->frozen) return;
  const MachineStatus status = impl_->gateway.status();
  FlightRing::put(impl_->ring->job, status.job);
  FlightRing::Sample& row = impl_->ring->next_sample();
  row.when_ns = now.count();
  row.path_time_s = status.path_time_s;
  row.rate = status.rate;
  row.progress = status.progress;
  row.line = status.line;
  row.state = static_cast<std::uint8_t>(status.state);
  row.positions_known = status.positions_known ? 1 : 0;
  row.joint_count = static_cast<std::uint8_t>(std::min<int>(status.joint_count, FlightRing::kJoints));
  for (std::size_t i = 0; i < row.joint_count; ++i) row.joints[i] = row.measured[i] = status.joints[i];
  for (std::size_t i = 0; i < row.joint_count; ++i) row.measured[i] -= status.off_course[i].value_or(0);
  std::copy_n(status.machine_pose.begin(), row.pose.size(), row.pose.begin());
  int sync_error_us = 0;
  for (const NodeStatus& node : status.nodes) sync_error_us = std::max(sync_error_us, node.sync_error_us);
  row.sync_error_us = static_cast<std::uint16_t>(sync_error_us);
}

LocalTime FlightRecorder::next_deadline() const {
  return impl_->ring == nullptr ? LocalTime::max() : std::min(impl_->next_sample, impl_->report_at);
}

}  // namespace kinebus
