#include "gateway/fleet/demo/demo.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gateway/fleet/agent.hpp"
#include "gateway/fleet/demo/child_process.hpp"
#include "gateway/fleet/wall/wall_server.hpp"

namespace kinebus::fleet {
namespace {

namespace fs = std::filesystem;
using Children = std::vector<std::unique_ptr<ChildProcess>>;
constexpr auto kBegunWithin = std::chrono::seconds{60};
constexpr const char* kDatabaseUser = "postgres";  // Debian's; PostgreSQL does not run as root
constexpr int kPartLayers = 6;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "kinebus-fleet-demo-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + " cannot be made");
    path = name;
    fs::permissions(path, fs::perms(0755));
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  fs::path path;
};

/// The newest of what Debian has installed.
fs::path postgres_folder() {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", error))
    if (fs::exists(version.path() / "bin/postgres")) found.push_back(version.path() / "bin");
  if (found.empty()) throw std::runtime_error("PostgreSQL is not installed: apt install postgresql");
  return *std::max_element(found.begin(), found.end());
}

std::string beside_us(const char* program) {
  const fs::path path = fs::read_symlink("/proc/self/exe").parent_path() / program;
  return fs::exists(path) ? path.string() : program;
}

std::string start_database(const fs::path& folder, Children& children) {
  const fs::path programs = postgres_folder();
  const fs::path place = folder / "database";
  fs::create_directory(place);
  std::string user;
  if (::geteuid() == 0) {
    user = kDatabaseUser;
    const passwd* const found = ::getpwnam(user.c_str());
    if (found == nullptr || ::chown(place.c_str(), found->pw_uid, found->pw_gid) != 0)
      throw std::runtime_error("PostgreSQL does not run as root, and there is no user postgres");
  }
  const std::string log = folder / "database.log", data = place / "data";
  ChildProcess made({programs / "initdb", "-D", data, "-A", "trust", "-U", "fleet", "--no-instructions"}, log,
                    user);
  if (made.wait() != 0) throw std::runtime_error("initdb failed, see " + log);
  children.push_back(std::make_unique<ChildProcess>(
      std::vector<std::string>{programs / "postgres", "-D", data, "-k", place, "-c", "listen_addresses="},
      log, user));
  return "host=" + place.string() + " user=fleet dbname=postgres";
}

/// Of this computer; nothing: it is taken. 0: one that is free.
std::optional<int> take_port(int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  const int reuse = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  const bool free = ::bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                    ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(fd);
  return free ? std::optional<int>(ntohs(address.sin_port)) : std::nullopt;
}

/// Nothing: there is none on this computer. Another broker may have the port that everybody knows.
std::optional<Broker::Options> start_broker(const fs::path& folder, Children& children) {
  const fs::path program = "/usr/sbin/mosquitto";
  if (!fs::exists(program)) {
    fmt::print("no broker: mosquitto is not installed\n");
    return std::nullopt;
  }
  Broker::Options options{.node = "demo"};
  if (!take_port(options.port)) options.port = take_port(0).value_or(options.port);
  std::ofstream(folder / "mosquitto.conf")
      << "listener " << options.port << " 127.0.0.1\nallow_anonymous true\n";
  children.push_back(std::make_unique<ChildProcess>(
      std::vector<std::string>{program, "-c", folder / "mosquitto.conf"}, folder / "broker.log"));
  fmt::print("broker of MQTT: 127.0.0.1:{}\n", options.port);
  return options;
}

std::vector<ServedGateway> start_machines(const fs::path& folder, int count, Children& children) {
  std::vector<ServedGateway> gateways;
  for (int number = 1; number <= count; ++number) {
    const std::string name = fmt::format("machine-{:02}", number);
    const std::string socket = folder / (name + ".sock");
    children.push_back(std::make_unique<ChildProcess>(
        std::vector<std::string>{beside_us("kinebusd"), "--bus", "inproc", "--socket", socket, "--jobs",
                                 folder / name / "jobs", "--no-realtime", "--no-mdns"},
        folder / (name + ".log")));
    gateways.push_back({.machine = {.name = name,
                                    .kind = "m1",
                                    .material = number % 2 == 0 ? "PLA" : "PETG",
                                    .nozzle_mm = 0.4},
                        .reach = {.client = "kinebus-fleet", .socket = socket}});
  }
  return gateways;
}

void init_when_it_answers(Queue& queue) {
  const auto end = std::chrono::steady_clock::now() + kBegunWithin;
  for (;;) try {
      return queue.init();
    } catch (const DatabaseError&) {
      if (std::chrono::steady_clock::now() > end) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds{200});
    }
}

std::string part(int side_mm) {
  std::string text = "; a square, in the air\nG21\nG90\n";
  for (int layer = 0; layer < kPartLayers; ++layer) {
    text += fmt::format("G1 Z{} F600\n", layer);
    text += fmt::format("G1 X{0} Y0 F1500\nG1 X{0} Y{0}\nG1 X0 Y{0}\nG1 X0 Y0\n", side_mm);
  }
  return text;
}

}  // namespace

void run_demo(const DemoOptions& options, const std::atomic<bool>& quit) {
  const TemporaryFolder folder;
  Children children;
  AgentOptions agent{.database = start_database(folder.path, children),
                     .policy = {.home = true, .give_up = true}};
  agent.broker = start_broker(folder.path, children);
  agent.gateways = start_machines(folder.path, options.machines, children);
  Queue queue(agent.database);
  init_when_it_answers(queue);
  for (int job = 0; job < options.jobs; ++job) {
    const int side_mm = 5 + 5 * (job % 3);
    queue.add(part(side_mm), {.name = fmt::format("square-{}.gcode", side_mm),
                              .kind = "m1",
                              .material = job % 3 == 0 ? "PETG" : "",
                              .priority = job % 4 == 0 ? 1 : 0});
  }
  fmt::print("{} machines, {} jobs; everything is in {} and gone when this ends\n--database '{}'\n",
             options.machines, options.jobs, folder.path.string(), agent.database);
  std::atomic<bool> over{false};
  std::thread serving([&] { run_agent(agent, over); });
  try {
    serve_wall({.database = agent.database, .address = options.http}, quit);
  } catch (...) {
    over = true;
    serving.join();
    throw;
  }
  over = true;
  serving.join();
}

}  // namespace kinebus::fleet
