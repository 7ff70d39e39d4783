#pragma once
// The job link's side of the USB gadget: tells FunctionFS what the interface is, follows the host's coming
// and going, and gives every conversation a session of its own.
//
// The gadget itself (configfs) is set up by kinebus-usb-gadget and may come and go too: the folder is looked
// for again and again. Nothing here ever touches the machine.

#include <functional>
#include <memory>
#include <string>

#include "gateway/io/daemon_part.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/io/usb/usb_pipe.hpp"

namespace kinebus {

class FunctionFs : public DaemonPart {
 public:
  /// Makes the session of a new conversation; nullptr: there are too many.
  using NewSession = std::function<std::unique_ptr<ByteSession>(LocalTime now)>;
  struct Counters {
    std::uint32_t enabled = 0, disabled = 0, sessions = 0, failures = 0;
  };

  /// `folder`: where FunctionFS is mounted. All must outlive this; the hub must be destroyed first.
  FunctionFs(EventLoop& loop, StreamHub& hub, std::string folder, NewSession new_session);
  ~FunctionFs() override;
  FunctionFs(const FunctionFs&) = delete;
  FunctionFs& operator=(const FunctionFs&) = delete;

  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  const Counters& counters() const { return counters_; }

 private:
  bool open();
  void close();
  void read_events();
  void enable();
  void disable();
  void listen();
  void on_pipe();

  EventLoop& loop_;
  StreamHub& hub_;
  std::string folder_;
  NewSession new_session_;
  int control_ = -1, out_ = -1, in_ = -1;
  std::shared_ptr<UsbPipe> pipe_;
  std::shared_ptr<bool> in_use_;  ///< a stream uses the pipe
  bool listening_ = false;        ///< the pipe's fd is watched here, until somebody speaks
  LocalTime next_open_{0};
  Counters counters_;
};

}  // namespace kinebus
