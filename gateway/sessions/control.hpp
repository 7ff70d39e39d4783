#pragma once
// Who may command the machine: at most one client at a time, whatever it is connected by. The others watch.
// Stopping the machine needs no control. A client that vanishes loses control, never the job.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus {

using ClientId = std::uint32_t;  ///< from 1; 0: nobody

class Control {
 public:
  struct Client {
    ClientId id = 0;
    std::string name;
    std::string transport;  ///< "local", "usb", "tcp 10.0.0.7", "serial"
  };

  ClientId attach(std::string name, std::string transport);
  /// The client is gone.
  void detach(ClientId client);

  /// False: another client has control, and `force` was not asked for.
  bool take(ClientId client, bool force);
  void release(ClientId client);
  /// False: `from` has no control, or `to` is nobody.
  bool hand_over(ClientId from, ClientId to);
  /// For a command: gives control to `client` when nobody has it. False: another client has it.
  bool may_command(ClientId client) { return take(client, false); }

  ClientId holder() const { return holder_; }
  std::string name_of(ClientId client) const;
  const std::vector<Client>& clients() const { return clients_; }

 private:
  std::vector<Client> clients_;
  ClientId last_ = 0;
  ClientId holder_ = 0;
};

}  // namespace kinebus
