#pragma once
// Tells the network by mDNS (avahi's daemon) where this gateway serves HTTP, so that slicers and managers of
// printers find it by name. It lives on a thread of its own: nobody waits for the daemon, which may come, go
// and come again.

#include <cstdint>
#include <memory>
#include <string>

namespace kinebus {

class Announcer {
 public:
  struct Options {
    std::string name;         ///< of the machine; one that is taken gets a number
    std::uint16_t port = 0;   ///< by TLS
    std::string octoprint{};  ///< the version of OctoPrint whose API is served
    std::string version{};    ///< of this program
  };
  /// False: this program was built without avahi, and nothing is announced.
  static bool built_in();

  explicit Announcer(Options options);
  /// Takes back what is announced.
  ~Announcer();
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;

 private:
  std::shared_ptr<void> avahi_;  ///< the thread and what is announced
};

}  // namespace kinebus
