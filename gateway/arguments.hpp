#pragma once
// What kinebusd is told on its command line.

#include <string>
#include <vector>

#include "gateway/io/usb/serial_ports.hpp"

namespace CLI {
class App;
}

namespace kinebus {

struct Arguments {
  std::string machine;
  std::string new_machine;
  std::string bus;
  std::string socket;
  std::string group;
  std::string jobs;
  std::string bus_log;
  SerialPorts::Options serial;
  std::string usb;
  std::string journal;
  std::string flight;
  std::string tcp;
  std::string credentials;
  std::string http;
  std::string http_key;
  std::string http_users;
  std::string web;
  bool mdns = true;
  std::vector<std::string> http_names;
  double quota_gib = 16;
  std::string log_level = "info";
  int realtime_priority = 80;
  bool no_realtime = false;
};

/// The options of the command line; they are read into `arguments`, which must outlive the parsing.
void add_options(CLI::App& app, Arguments& arguments);

/// After the parsing: the file of --new-machine is the machine file, with the default machine where it is not
/// there. What cannot be written is thrown as words for the user (std::runtime_error).
void make_machine_file(Arguments& arguments);

}  // namespace kinebus
