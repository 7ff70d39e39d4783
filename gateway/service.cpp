#include "gateway/service.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "gateway/description/machine_file.hpp"
#include "gateway/io/bus_log.hpp"
#include "gateway/io/daemon.hpp"
#include "gateway/io/service_manager.hpp"
#include "gateway/io/socketcan_bus.hpp"
#include "gateway/io/web_folder.hpp"
#include "gateway/sessions/http/api.hpp"
#include "protocol/bytes.hpp"
#include "protocol/host/realtime.hpp"
#include "protocol/host/socketcan.hpp"
#include "protocol/joblink/sha256.hpp"
#include "tools/simulation/bus/inproc_bus.hpp"

namespace kinebus {
namespace {

/// The bus inside the process.
constexpr std::string_view kInproc = "inproc";
/// What jobs, clients and plans take of the heap: 16 MB for a small one (kinebus-loop-watch counts the
/// pages).
constexpr std::size_t kHeapBytes = 24 << 20;
constexpr double kBytesPerGib = 1073741824;
/// Clients' part of the loop's time, of those near the machine and those of the network. With what was saved
/// and with planning it is less than the 95 % of a second at which Linux stops a real-time thread until the
/// second is over. What the network leaves of its part is for those near the machine, too. A stop from nearby
/// hardly waits for SYNC.
constexpr StreamHub::Options kNear{.share = 0.15,
                                   .burst = std::chrono::milliseconds{50},
                                   .most_kept_clear = std::chrono::milliseconds{1},
                                   .at_once = true};
constexpr StreamHub::Options kFar{.share = 0.5, .burst = std::chrono::milliseconds{100}};
/// Of the network's part: who has control may also ask for its 20 statuses a second. Of all others who may
/// stop each has a little: a stop, a hold, a word now and then; who uploads, lists jobs, floods, or comes and
/// goes is served with everybody else. Of a crowd of the 50 that there is room for at the HTTP port each has
/// more than 0.5 % of the loop: it must not pass for frugal.
constexpr StreamHub::Options kControl{
    .share = 0.1,
    .burst = std::chrono::milliseconds{20},
    .at_once = true,
    .frugal = {.share = 0.1, .burst = std::chrono::milliseconds{20}, .pause = std::chrono::seconds{1}}};
constexpr StreamHub::Options kMayStop{.share = 0.1,
                                      .burst = std::chrono::milliseconds{10},
                                      .at_once = true,
                                      .frugal = {.share = 0.005,
                                                 .burst = std::chrono::milliseconds{5},
                                                 .pause = std::chrono::seconds{5},
                                                 .trial = std::chrono::seconds{5}},
                                      .frugal_together = 0.1};
/// Who comes by the job link does not wait with the crowd at the HTTP port: the first second of a client that
/// only says stop is spent with greetings.
constexpr StreamHub::Options kLink{
    .max_streams = 64, .share = 0.3, .burst = std::chrono::milliseconds{50}, .at_once = true};

template <typename T>
T must(Result<T, std::string> result, const std::string& what = {}) {
  if (!result) throw std::runtime_error(what + result.error());
  return std::move(*result);
}

void must_be_empty(const std::string& error, const char* what) {
  if (!error.empty()) throw std::runtime_error(std::string(what) + " " + error);
}

MachineDescription read_machine(const std::string& path) {
  if (path.empty()) return default_m1();
  auto machine = load_machine(path);
  if (!machine) throw std::runtime_error(to_string(machine.error()));
  return *machine;
}

std::unique_ptr<BusPort> open_bus(const std::string& name, const MachineDescription& machine,
                                  const std::string& log, LocalTime now) {
  std::unique_ptr<BusPort> bus;
  if (name == kInproc)
    bus = std::make_unique<InprocBus>(machine, now);
  else
    bus = must(SocketCanBus::open(name));
  if (!log.empty()) return must(LoggedBus::open(std::move(bus), log), "bus log ");
  return bus;
}

std::string default_socket() {
  if (const char* named = std::getenv("KINEBUS_SOCKET")) return named;
  if (::geteuid() == 0 || std::getenv("RUNTIME_DIRECTORY") != nullptr) return "/run/kinebus/kinebus.sock";
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr ? std::string(runtime) + "/kinebus.sock" : "/tmp/kinebus.sock";
}

double unix_now() {
  return unix_s_at_zero() + to_seconds(monotonic_now());
}

std::filesystem::path beside(const std::string& jobs_folder, const char* name) {
  return std::filesystem::absolute(jobs_folder).parent_path() / name;
}

/// In systemd's folder for this service, which is memory and stays when the daemon is started again by
/// itself; else in the user's folder in memory, or everybody's. Nothing: there is none.
std::filesystem::path flight_memory(const std::string& jobs_folder) {
  if (const char* runtime = std::getenv("RUNTIME_DIRECTORY"))
    return std::filesystem::path(runtime) / "flight-memory";
  const char* own = std::getenv("XDG_RUNTIME_DIR");
  const std::filesystem::path memory = own != nullptr ? own : "/dev/shm";
  std::error_code error;
  if (!std::filesystem::is_directory(memory, error)) return {};
  const std::string place = std::filesystem::absolute(jobs_folder).string() + std::to_string(::geteuid());
  return memory / ("kinebus-flight-" + joblink::to_hex(joblink::sha256_of(place)).substr(0, 16));
}

/// The machine's id of this installation, or the place of its jobs where the system has none.
std::string gateway_id(const std::string& jobs_folder) {
  std::string id = jobs_folder;
  if (std::ifstream in("/etc/machine-id"); in) {
    std::string line;
    in >> line;
    id += line;
  }
  return joblink::to_hex(joblink::sha256_of("kinebus gateway " + id)).substr(0, 16);
}

std::string machine_mark(MachineFileStore& file) {
  const auto text = file.read();
  return text ? joblink::to_hex(joblink::sha256_of(text->text)) : std::string();
}

SipHashKey random_key() {
  const std::string bytes = random_bytes(16);
  std::array<std::uint8_t, 16> key{};
  std::copy_n(bytes.begin(), key.size(), key.begin());
  return {get_u64_le(key), get_u64_le(std::span(key).subspan(8))};
}

/// The epoch differs from the one before: nodes then join the new clock without a step.
Gateway::Options gateway_options(const journal::State& noted) {
  // 50 lines take 1 ms of a small board: SYNC, a stop and clients wait no longer for a piece.
  return {.epoch = static_cast<std::uint8_t>(noted.epoch ? *noted.epoch + 1 : std::random_device{}()),
          .planning_budget = 50,
          .unix_s_at_zero = unix_s_at_zero(),
          .bus_secret = random_key(),
          .journal = true};
}

JobLinkServer::Options server_options(const std::string& jobs_folder, MachineFileStore& machine_file,
                                      const std::string& bus, std::function<void()> restart) {
  return {.version = KINEBUS_VERSION,
          .gateway_id = gateway_id(jobs_folder),
          .secret = random_bytes(32),
          .machine_mark = machine_mark(machine_file),
          .unix_s_at_zero = unix_s_at_zero(),
          .bus = bus,
          .restart = std::move(restart)};
}

}  // namespace

Service::Service(const Arguments& arguments)
    : arguments_(arguments),
      machine_(read_machine(arguments.machine)),
      bus_name_(arguments.bus.empty() ? machine_.bus.interface : arguments.bus),
      jobs_folder_(arguments.jobs.empty() ? machine_.jobs_directory : arguments.jobs),
      socket_(arguments.socket.empty() ? default_socket() : arguments.socket),
      journal_path_(arguments.journal.empty() ? beside(jobs_folder_, "resume.journal")
                                              : std::filesystem::absolute(arguments.journal)),
      loop_(bus_name_ == kInproc ? LoopClock::Kind::kOwn : LoopClock::Kind::kMonotonic),
      bus_((lock(), open_bus(bus_name_, machine_, arguments.bus_log, loop_.now()))),
      store_(JobStore::open({.folder = jobs_folder_,
                             .quota_bytes = static_cast<std::uint64_t>(arguments.quota_gib * kBytesPerGib),
                             .reads_ahead = true},
                            unix_now())),
      noted_(JournalFile::read(journal_path_)),
      gateway_(machine_, gateway_options(noted_)),
      journal_(journal_path_, noted_, gateway_),
      machine_file_(arguments.machine, write_machine(machine_)),
      worker_(loop_),
      server_(gateway_, machine_, *store_, worker_, machine_file_, control_,
              server_options(jobs_folder_, machine_file_, bus_name_, [this] { begins_anew_ = true; })),
      near_(loop_, kNear),
      hub_(loop_, kFar),
      host_(loop_, near_, hub_, server_),
      http_host_(loop_, hub_),
      serial_files_(*store_, worker_, gateway_, server_),
      serial_(loop_, gateway_, serial_files_, control_, arguments.serial),
      usb_(loop_, near_, arguments.usb,
           [this](LocalTime now) {
             return server_.open(now, {.transport = "usb", .token = {}, .lasting = true});
           }),
      recorder_({.folder = arguments.flight.empty() ? journal_path_.parent_path() / "flight"
                                                    : std::filesystem::path(arguments.flight),
                 .memory = flight_memory(jobs_folder_),
                 .machine = machine_.name,
                 .interface = bus_name_},
                gateway_) {
  for (const std::string& note : store_->notes()) spdlog::warn("{}", note);
  take_up_what_was_noted();
  listen();
}

/// A daemon that is started twice by mistake must not open, read or write anything of the first one's.
void Service::lock() {
  // The usual place is there for everybody; one that was named by hand may be a slip.
  if (arguments_.socket.empty()) {
    std::error_code cannot;
    std::filesystem::create_directories(std::filesystem::path(socket_).parent_path(), cannot);
  }
  for (const std::string& taken :
       {lock_.take_file(socket_), lock_.take_folder(jobs_folder_), lock_.take_file(journal_path_)})
    if (!taken.empty()) throw std::runtime_error(taken);
}

void Service::take_up_what_was_noted() {
  std::unique_ptr<ByteSource> job;
  if (!noted_.job)
    store_->forget_kept();
  else if (auto text = store_->open_kept(noted_.job->name); text)
    job = std::move(*text);
  if (const auto taken = gateway_.recover(noted_, std::move(job)); !taken)
    spdlog::warn("{}", taken.error().words);
}

void Service::listen() {
  hub_.comes_after(near_);
  hub_.leaves_to(near_);  // an upload by USB, mostly
  hub_.add_lane(ByteSession::Rank::kInControl, kControl);
  hub_.add_lane(ByteSession::Rank::kMayStop, kMayStop);
  hub_.add_side(kLink);
  for (StreamHub* const hub : {&near_, &hub_}) hub->keep_clear_of([this] { return gateway_.sync_due(); });
  must_be_empty(host_.listen_local(socket_, arguments_.group), "local socket");
  const std::string folder = arguments_.credentials.empty() ? jobs_folder_ + "/.tls" : arguments_.credentials;
  if (!arguments_.http.empty()) listen_http(folder);
  if (!arguments_.tcp.empty()) {
    must_be_empty(host_.listen_tcp(arguments_.tcp, folder), "TCP");
    spdlog::info("TCP port {}, fingerprint {}, token in {}/token", host_.tcp_port(), host_.tls_fingerprint(),
                 folder);
  }
  must_be_empty(serial_.open(), "serial port");
  if (const std::string missing = recorder_.open(); !missing.empty())
    spdlog::warn("no flight recorder: {}", missing);
  spdlog::info("{} on bus {}, listening at {}", machine_.name, bus_name_, socket_);
}

void Service::listen_http(const std::string& credentials) {
  std::filesystem::create_directories(credentials);
  const std::string file = arguments_.http_key.empty() ? credentials + "/http-key" : arguments_.http_key;
  const std::filesystem::path pages =
      arguments_.web.empty() ? installed_pages() : std::filesystem::path(arguments_.web);
  const std::filesystem::path kept = beside(jobs_folder_, "web-pages.json");
  const UsersFile::Files users{
      .key = file,
      .users = arguments_.http_users.empty() ? credentials + "/http-users.toml" : arguments_.http_users,
      .must_be_there = !arguments_.http_users.empty()};
  http_.emplace(
      server_, *store_, worker_, control_,
      http::Server::Options{.users = must(UsersFile::read(users)),
                            .names = host_names(arguments_.http_names),
                            .pages = pages.empty() ? http::Pages() : must(read_pages(pages), "web page "),
                            .database = read_text(kept),
                            .keep_database = text_keeper(kept)});
  users_.emplace(loop_, worker_, users);
  const std::string wrong = http_host_.listen(arguments_.http, credentials, *http_);
  // A page of another program is no reason for a machine to stand.
  if (http_host_.taken()) return spdlog::error("no web page and no slicers: {}", wrong);
  must_be_empty(wrong, "HTTP");
  if (!pages.empty()) spdlog::info("web page from {}", pages.string());
  spdlog::info("{} port {}, API key in {}", http_host_.encrypted() ? "HTTPS" : "HTTP", http_host_.port(),
               file);
  // Nobody else can reach what is not encrypted.
  if (!arguments_.mdns || !http_host_.encrypted()) return;
  if (!Announcer::built_in())
    return spdlog::info("mDNS: not announced, this kinebusd was built without avahi");
  announcer_.emplace(Announcer::Options{.name = machine_.name,
                                        .port = static_cast<std::uint16_t>(http_host_.port()),
                                        .octoprint = http::kOctoPrintApi,
                                        .version = KINEBUS_VERSION});
}

void Service::run(const volatile std::sig_atomic_t* quit, volatile std::sig_atomic_t* reread) {
  RecordedBus recorded(std::move(bus_), recorder_);
  worker_.pass(hub_.gate(worker_.fd()));
  const ServiceManager manager;
  manager.tell("READY=1");
  Daemon daemon(loop_, recorded, gateway_, manager);
  daemon.add(recorder_);
  daemon.add(host_);
  daemon.add(http_host_);
  daemon.add(near_);
  daemon.add(hub_);
  daemon.add(serial_);
  if (!arguments_.usb.empty()) daemon.add(usb_);
  daemon.add(journal_);
  if (users_) {
    users_->keep(*http_, reread);
    daemon.add(*users_);
  }
  keep_heap(kHeapBytes);
  if (!arguments_.no_realtime)
    if (const std::string missing = become_realtime(arguments_.realtime_priority); !missing.empty())
      spdlog::warn("running without {}: expect more jitter", missing);
  daemon.run(quit, begins_anew_);
}

}  // namespace kinebus
