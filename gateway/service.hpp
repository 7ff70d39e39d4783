#pragma once
// kinebusd's parts, built in the order in which they need each other, and their loop.

#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "gateway/arguments.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/io/bus_port.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/flight_recorder.hpp"
#include "gateway/io/http_host.hpp"
#include "gateway/io/instance_lock.hpp"
#include "gateway/io/job_link_host.hpp"
#include "gateway/io/journal_file.hpp"
#include "gateway/io/machine_file_store.hpp"
#include "gateway/io/mdns/announcer.hpp"
#include "gateway/io/store_files.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/io/usb/function_fs.hpp"
#include "gateway/io/usb/serial_ports.hpp"
#include "gateway/io/users_file.hpp"
#include "gateway/io/worker_thread.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/sessions/control.hpp"
#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/job_link_server.hpp"

namespace kinebus {

class Service {
 public:
  /// What cannot be opened is thrown as words for the user (std::runtime_error).
  explicit Service(const Arguments& arguments);
  /// Until *quit, then until the machine rests. *reread: what may change meanwhile is read anew.
  void run(const volatile std::sig_atomic_t* quit, volatile std::sig_atomic_t* reread);
  /// A client wants it to begin anew, with the machine file as it is now.
  bool begins_anew() const { return begins_anew_; }

 private:
  void lock();
  void take_up_what_was_noted();
  void listen();
  void listen_http(const std::string& credentials);

  const Arguments& arguments_;
  bool begins_anew_ = false;
  MachineDescription machine_;
  std::string bus_name_, jobs_folder_, socket_;
  std::filesystem::path journal_path_;
  InstanceLock lock_;
  EventLoop loop_;
  std::unique_ptr<BusPort> bus_;
  std::unique_ptr<JobStore> store_;
  journal::State noted_;
  Gateway gateway_;
  JournalFile journal_;
  MachineFileStore machine_file_;
  WorkerThread worker_;
  Control control_;
  JobLinkServer server_;
  std::optional<http::Server> http_;
  std::optional<UsersFile> users_;
  std::optional<Announcer> announcer_;
  StreamHub
      near_;  ///< the local socket and USB: whoever stands at the machine does not wait behind a network
  StreamHub hub_;
  JobLinkHost host_;
  HttpHost http_host_;
  StoreFiles serial_files_;
  SerialPorts serial_;
  FunctionFs usb_;
  FlightRecorder recorder_;
};

}  // namespace kinebus
