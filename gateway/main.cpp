// kinebusd: builds the parts of the gateway, connects them, and loops.

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "gateway/inproc/inproc_bus.hpp"
#include "gateway/io/bus_log.hpp"
#include "gateway/io/daemon.hpp"
#include "gateway/io/flight_recorder.hpp"
#include "gateway/io/job_link_host.hpp"
#include "gateway/io/journal_file.hpp"
#include "gateway/io/machine_file_store.hpp"
#include "gateway/io/socketcan_bus.hpp"
#include "gateway/io/store_files.hpp"
#include "gateway/io/systemd_notify.hpp"
#include "gateway/io/usb/function_fs.hpp"
#include "gateway/io/usb/serial_ports.hpp"
#include "gateway/io/worker_thread.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/machine/description/machine_file.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/realtime.hpp"
#include "protocol/joblink/sha256.hpp"

namespace {

volatile std::sig_atomic_t quit = 0;
void on_signal(int) {
  quit = 1;
}

struct Arguments {
  std::string machine;
  std::string bus;
  std::string socket;
  std::string group;
  std::string jobs;
  std::string bus_log;
  kinebus::SerialPorts::Options serial;
  std::string usb;
  std::string journal;
  std::string flight;
  std::string tcp;
  std::string credentials;
  double quota_gib = 16;
  std::string log_level = "info";
  int realtime_priority = 80;
  bool no_realtime = false;
};

std::string default_socket() {
  if (const char* named = std::getenv("KINEBUS_SOCKET")) return named;
  if (::geteuid() == 0 || std::getenv("RUNTIME_DIRECTORY") != nullptr) return "/run/kinebus/kinebus.sock";
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr ? std::string(runtime) + "/kinebus.sock" : "/tmp/kinebus.sock";
}

kinebus::Result<kinebus::MachineDescription, std::string> read_machine(const std::string& path) {
  if (path.empty()) return kinebus::default_m1();
  auto machine = kinebus::load_machine(path);
  if (!machine) return kinebus::Error<std::string>(kinebus::to_string(machine.error()));
  return *machine;
}

kinebus::Result<std::unique_ptr<kinebus::BusPort>, std::string> open_bus(
    const std::string& name, const kinebus::MachineDescription& machine) {
  if (name == "inproc") return std::make_unique<kinebus::InprocBus>(machine, kinebus::monotonic_now());
  auto bus = kinebus::SocketCanBus::open(name);
  if (!bus) return kinebus::Error<std::string>(bus.error());
  return std::move(*bus);
}

double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// The machine's id of this installation, or the place of its jobs where the system has none.
std::string gateway_id(const std::string& jobs_folder) {
  std::string id = jobs_folder;
  if (std::ifstream in("/etc/machine-id"); in) {
    std::string line;
    in >> line;
    id += line;
  }
  return kinebus::joblink::to_hex(kinebus::joblink::sha256_of("kinebus gateway " + id)).substr(0, 16);
}

std::string machine_mark(kinebus::MachineFileStore& file) {
  const auto text = file.read();
  return text ? kinebus::joblink::to_hex(kinebus::joblink::sha256_of(text->text)) : std::string();
}

int fail(const std::string& words) {
  spdlog::critical("{}", words);
  return 1;
}

int serve(const Arguments& arguments) {
  const auto machine = read_machine(arguments.machine);
  if (!machine) return fail(machine.error());

  auto bus = open_bus(arguments.bus.empty() ? machine->bus.interface : arguments.bus, *machine);
  if (!bus) return fail(bus.error());
  if (!arguments.bus_log.empty()) bus = kinebus::LoggedBus::open(std::move(*bus), arguments.bus_log);
  if (!bus) return fail("bus log " + bus.error());

  const std::string jobs_folder = arguments.jobs.empty() ? machine->jobs_directory : arguments.jobs;
  const auto store = kinebus::JobStore::open(
      {.folder = jobs_folder, .quota_bytes = static_cast<std::uint64_t>(arguments.quota_gib * 1073741824.0)},
      unix_now());
  for (const std::string& note : store->notes()) spdlog::warn("{}", note);

  kinebus::EventLoop loop;
  const std::filesystem::path journal_path =
      arguments.journal.empty() ? std::filesystem::absolute(jobs_folder).parent_path() / "resume.journal"
                                : std::filesystem::absolute(arguments.journal);
  const kinebus::journal::State noted = kinebus::JournalFile::read(journal_path);
  // The epoch must differ from the one before: nodes then join the new clock without a step.
  const auto epoch = static_cast<std::uint8_t>(noted.epoch ? *noted.epoch + 1 : std::random_device{}());
  kinebus::Gateway gateway(*machine, {.epoch = epoch, .journal = true});
  kinebus::JournalFile journal(journal_path, noted, gateway);
  if (noted.job) {
    auto text = store->open_job(noted.job->name);
    if (const auto taken = gateway.recover(noted, text ? std::move(*text) : nullptr); !taken)
      spdlog::warn("{}", taken.error().words);
  }
  kinebus::MachineFileStore machine_file(arguments.machine, kinebus::write_machine(*machine));
  kinebus::WorkerThread worker(loop);
  kinebus::Control control;
  kinebus::JobLinkServer server(
      gateway, *machine, *store, worker, machine_file, control,
      {.version = KINEBUS_VERSION,
       .gateway_id = gateway_id(jobs_folder),
       .secret = kinebus::random_bytes(32),
       .machine_mark = machine_mark(machine_file),
       .unix_s_at_zero = unix_now() - kinebus::to_seconds(kinebus::monotonic_now())});
  kinebus::StreamHub hub(loop);
  kinebus::JobLinkHost host(loop, hub, server);
  const std::string socket = arguments.socket.empty() ? default_socket() : arguments.socket;
  if (std::string error = host.listen_local(socket, arguments.group); !error.empty())
    return fail("local socket " + error);
  if (!arguments.tcp.empty()) {
    const std::string folder = arguments.credentials.empty() ? jobs_folder + "/.tls" : arguments.credentials;
    if (std::string error = host.listen_tcp(arguments.tcp, folder); !error.empty())
      return fail("TCP " + error);
    spdlog::info("TCP port {}, fingerprint {}, token in {}/token", host.tcp_port(), host.tls_fingerprint(),
                 folder);
  }

  kinebus::StoreFiles serial_files(*store, worker, gateway, server);
  kinebus::SerialPorts serial(loop, gateway, serial_files, arguments.serial);
  if (std::string error = serial.open(); !error.empty()) return fail("serial port " + error);
  kinebus::FunctionFs usb(loop, hub, arguments.usb, [&server](kinebus::LocalTime now) {
    return server.open(now, {.transport = "usb", .token = {}});
  });

  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGPIPE, SIG_IGN);
  spdlog::info("{} on bus {}, listening at {}", machine->name,
               arguments.bus.empty() ? machine->bus.interface : arguments.bus, socket);
  kinebus::notify_systemd("READY=1");
  kinebus::FlightRecorder recorder(
      {.folder = arguments.flight.empty() ? journal_path.parent_path() / "flight"
                                          : std::filesystem::path(arguments.flight),
       .machine = machine->name,
       .interface = arguments.bus.empty() ? machine->bus.interface : arguments.bus},
      gateway);
  if (std::string missing = recorder.open(); !missing.empty())
    spdlog::warn("no flight recorder: {}", missing);
  kinebus::RecordedBus recorded(std::move(*bus), recorder);
  kinebus::Daemon daemon(loop, recorded, gateway);
  daemon.add(recorder);
  daemon.add(host);
  daemon.add(hub);
  daemon.add(serial);
  if (!arguments.usb.empty()) daemon.add(usb);
  daemon.add(journal);
  if (!arguments.no_realtime)
    if (const std::string missing = kinebus::become_realtime(arguments.realtime_priority); !missing.empty())
      spdlog::warn("running without {}: expect more jitter", missing);
  daemon.run(&quit);
  spdlog::info("ended at rest");
  return 0;
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("kinebusd: the Kinebus gateway. Plans G-code and moves the machine's CAN nodes.");
  app.add_option("--machine", arguments.machine,
                 "Machine file (TOML); without it the built-in default machine M1")
      ->check(CLI::ExistingFile);
  app.add_option(
      "--bus", arguments.bus,
      "SocketCAN interface such as can0, or \"inproc\": simulated nodes inside this process (default: the "
      "machine file's)");
  app.add_option("--socket", arguments.socket,
                 "Local socket for 'kinebus' (default: /run/kinebus or the user's)");
  app.add_option("--group", arguments.group, "Group whose members may use the local socket");
  app.add_option("--tcp", arguments.tcp, "Also serve the job link by TLS on ADDRESS:PORT (default: off)");
  app.add_option("--credentials", arguments.credentials,
                 "Folder of the TLS certificate and the token (default: .tls in the folder of jobs)");
  app.add_option("--quota", arguments.quota_gib, "GiB that stored jobs may take")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option("--jobs", arguments.jobs, "Folder of stored jobs (default: the machine file's)");
  app.add_option(
      "--usb", arguments.usb,
      "Serve the job link as a USB device, on the FunctionFS mounted here (see kinebus-usb-gadget)");
  app.add_option("--serial-pty", arguments.serial.pty,
                 "Offer print hosts a serial port under this path (a link to a pty)");
  app.add_option(
      "--serial-device", arguments.serial.device,
      "Speak to print hosts on this serial device, whenever it is there (USB gadget: /dev/ttyGS0)");
  app.add_option(
      "--serial-tcp", arguments.serial.tcp,
      "Speak to print hosts on address:port; there is no password, use it in closed networks only");
  app.add_option("--bus-log", arguments.bus_log,
                 "Write all frames of the bus to this file, as candump -L does");
  app.add_option("--flight", arguments.flight,
                 "Folder of the flight recorder's reports (default: flight beside the jobs)");
  app.add_option(
      "--journal", arguments.journal,
      "File in which the place of the running job is noted (default: resume.journal beside the jobs)");
  app.add_option("--log-level", arguments.log_level, "trace debug info warn error")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error"}));
  app.add_option("--priority", arguments.realtime_priority, "SCHED_FIFO priority")->check(CLI::Range(1, 99));
  app.add_flag("--no-realtime", arguments.no_realtime, "Do not ask for SCHED_FIFO and locked memory");
  app.set_version_flag("--version", KINEBUS_VERSION);
  CLI11_PARSE(app, argc, argv);
  spdlog::set_default_logger(spdlog::stderr_logger_st("kinebusd"));
  spdlog::set_level(spdlog::level::from_str(arguments.log_level));
  try {
    return serve(arguments);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebusd", [&] { return run(argc, argv); });
}
