#pragma once
// The daemon's local socket: CLI and other local programs command and watch the machine here.

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <unordered_map>

#include "gateway/io/event_loop.hpp"
#include "gateway/io/job_files.hpp"
#include "gateway/machine/gateway.hpp"

namespace kinebus {

class ControlServer {
 public:
  struct Options {
    std::string path;   ///< of the socket
    std::string group;  ///< who may connect besides the owner; empty: only the owner
    int max_clients = 32;
  };
  ControlServer(EventLoop& loop, Gateway& gateway, JobFolder& jobs, Options options);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  std::string listen();  ///< empty: listening

  void on_event(const MachineEvent& event);  ///< to all who watch
  void on_time(LocalTime now);               ///< status to all whose turn it is
  LocalTime next_deadline() const;

 private:
  struct Client;
  void accept_client();
  void serve(Client& client, std::uint32_t events);
  bool take_upload(Client& client);
  bool take_line(Client& client);
  nlohmann::json begin_upload(Client& client, const nlohmann::json& request);
  nlohmann::json begin_watch(Client& client, const nlohmann::json& request);
  void close_client(int fd);

  EventLoop& loop_;
  Gateway& gateway_;
  JobFolder& jobs_;
  Options options_;
  int listener_ = -1;
  std::unordered_map<int, std::unique_ptr<Client>> clients_;
};

}  // namespace kinebus
