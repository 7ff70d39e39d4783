#pragma once
// Where print hosts reach the daemon: the gadget's serial port (ACM), a pty with a link of its own, TCP. On
// each speaks a session in Marlin's dialect.

#include <memory>
#include <string>
#include <vector>

#include "gateway/io/daemon_part.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/machine/gateway.hpp"
#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {

class SerialPorts : public DaemonPart {
 public:
  struct Options {
    std::string pty;     ///< path of the link to the pty; empty: none
    std::string device;  ///< a tty such as /dev/ttyGS0, opened whenever it is there; empty: none
    std::string tcp;     ///< "address:port" of this computer alone, as there is no password. Empty: none
  };
  SerialPorts(EventLoop& loop, Gateway& gateway, SerialFiles& files, Control& control, Options options);
  ~SerialPorts() override;
  SerialPorts(const SerialPorts&) = delete;
  SerialPorts& operator=(const SerialPorts&) = delete;

  std::string open();  ///< empty: done
  void on_event(const MachineEvent& event) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;

 private:
  class Session;
  class TcpSession;
  template <typename Kind>
  std::unique_ptr<ByteSession> new_session(const char* name);
  std::string open_pty();
  std::string listen_tcp();
  void accept_tcp();
  void try_device();

  EventLoop& loop_;
  Gateway& gateway_;
  SerialFiles& files_;
  Control& control_;
  Options options_;
  std::vector<MarlinSession*> sessions_;
  int pty_slave_ = -1, listener_ = -1;
  bool device_open_ = false;
  LocalTime next_device_{0};
  std::unique_ptr<StreamHub> hub_;  ///< last: its sessions leave sessions_
};

}  // namespace kinebus
