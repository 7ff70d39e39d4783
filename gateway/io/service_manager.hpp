#pragma once

#include <string>
#include <string_view>

namespace kinebus {

/// Whoever started this process (systemd) and wants to hear how it is: the protocol of sd_notify(3), without
/// waiting. A manager that does not read misses words; the loop goes on. (libsystemd's own sd_notify() waits
/// until the manager has taken all that was said before.)
class ServiceManager {
 public:
  /// The manager that $NOTIFY_SOCKET names; none: nobody is told anything.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  /// Such as "WATCHDOG=1". False: nobody took it.
  bool tell(std::string_view words) const;

 private:
  std::string path_;
  int socket_ = -1;
};

}  // namespace kinebus
