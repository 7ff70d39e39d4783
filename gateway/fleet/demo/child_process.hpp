#pragma once
// A program that runs beside this one, and never longer.

#include <sys/types.h>

#include <string>
#include <vector>

namespace kinebus::fleet {

class ChildProcess {
 public:
  /// `user`: whose rights it has; empty: ours. What it prints goes to the file `log`. Throws
  /// std::runtime_error.
  ChildProcess(const std::vector<std::string>& command, const std::string& log, const std::string& user = {});
  /// Ends it, and waits for it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Its exit status, when it has ended by itself.
  int wait();

 private:
  pid_t pid_ = -1;
};

}  // namespace kinebus::fleet
