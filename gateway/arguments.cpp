#include "gateway/arguments.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "gateway/description/default_machine_file.hpp"

namespace kinebus {

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--machine", arguments.machine,
                 "Machine file (TOML); without it the built-in default machine M1")
      ->check(CLI::ExistingFile);
  app.add_option("--new-machine", arguments.new_machine,
                 "Like --machine; where the file is not there, the default machine is written to it first, "
                 "with a comment "
                 "at each key")
      ->excludes("--machine");
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
  app.add_option(
         "--http", arguments.http,
         "Also serve slicers and managers of printers (OctoPrint's and PrusaLink's requests) by HTTP on "
         "ADDRESS:PORT; on an address that others can reach by HTTPS (default: off; the last of several "
         "counts)")
      ->take_last();
  app.add_option("--http-key", arguments.http_key,
                 "File of the API key that HTTP clients must know (default: http-key beside the token)");
  app.add_option("--http-users", arguments.http_users,
                 "File of more users with their roles and keys, and of networks that need none (default: "
                 "http-users.toml beside the token, where it is there)");
  app.add_option("--http-name", arguments.http_names,
                 "A name by which HTTP clients call this computer, besides its own and its addresses");
  app.add_flag("--mdns,!--no-mdns", arguments.mdns,
               "Tell the network by mDNS where HTTPS is served (default: yes, on an address that others can "
               "reach)");
  app.add_option("--web", arguments.web,
                 "Folder of the web page that is served by HTTP (default: the installed one)");
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
  app.add_option("--serial-tcp", arguments.serial.tcp,
                 "Speak to print hosts on address:port of this computer alone (127.0.0.1:2323), as there is "
                 "no password");
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
}

void make_machine_file(Arguments& arguments) {
  if (arguments.new_machine.empty()) return;
  arguments.machine = arguments.new_machine;
  if (std::filesystem::exists(arguments.machine)) return;
  std::ofstream out(arguments.machine);
  out << default_machine_file() << std::flush;
  if (!out) throw std::runtime_error(arguments.machine + " cannot be written");
}

}  // namespace kinebus
