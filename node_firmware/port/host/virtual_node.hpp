#pragma once
// The node core as a Linux process on SocketCAN: its event loop. The kernel's receive time stamps stand for
// the receive interrupt, a timer for the timer, a file for the flash, SIGUSR1 for the E-stop button.

#include <array>
#include <optional>

#include "node_firmware/core/node.hpp"
#include "node_firmware/port/host/axis_plant.hpp"
#include "node_firmware/port/host/image_file.hpp"
#include "node_firmware/port/host/position_trace.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {

struct VirtualNodeProcessOptions {
  std::string interface;
  NodeOptions node;
  std::array<AxisPlantOptions, 2> plant{};
  int emergency_input = 7;  ///< 1..7: SIGUSR1 turns its level
  std::string image_path;
  std::string trace_path;  ///< see PositionTrace; empty: none
};

class VirtualNodeProcess {
 public:
  explicit VirtualNodeProcess(const VirtualNodeProcessOptions& options);
  ~VirtualNodeProcess();
  VirtualNodeProcess(const VirtualNodeProcess&) = delete;
  VirtualNodeProcess& operator=(const VirtualNodeProcess&) = delete;

  /// Empty: ready. Otherwise what is wrong and what to do.
  std::string open();
  /// Until SIGTERM or SIGINT: empty. Otherwise why it could not go on.
  std::string run();

 private:
  void receive();
  void filter();
  void send();
  void look_at_switches(LocalTime now);
  void store();
  void arm_timer();
  /// True: end.
  bool on_signal();

  VirtualNodeProcessOptions options_;
  SocketCan can_;
  ImageFile image_;
  std::optional<Node> node_;
  std::array<AxisPlant, 2> plant_;
  std::array<SocketCan::Accept, 16> filters_{};
  std::optional<CanFrame> unsent_;
  PositionTrace trace_;
  LocalTime next_look_{0};
  bool emergency_ = false;
  bool bus_down_ = false;
  int epoll_ = -1, timer_ = -1, signals_ = -1;
};

}  // namespace kinebus
