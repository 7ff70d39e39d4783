#include "tools/flash/console_request.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <thread>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A pseudo-terminal with a node's console at the other end, which hears three letters.
struct Line {
  Line() : fd(::posix_openpt(O_RDWR | O_NOCTTY)) {
    EXPECT_EQ(::grantpt(fd), 0);
    EXPECT_EQ(::unlockpt(fd), 0);
    port = ::ptsname(fd);
    // Held open, so that the node's end does not see the line as gone before anybody has come.
    held = ::open(port.c_str(), O_RDWR | O_NOCTTY);
  }
  std::string hear() {
    std::string heard;
    while (heard.size() < 3) {
      std::array<char, 8> bytes{};
      const ssize_t count = ::read(fd, bytes.data(), bytes.size());
      if (count <= 0) break;
      heard.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return heard;
  }
  int fd, held;
  std::string port;
};

TEST(ConsoleRequest, IsGrantedWhenThePortGoes) {
  Line line;
  std::string heard;
  std::thread node([&] {
    heard = line.hear();
    ::close(line.fd);
  });
  EXPECT_EQ(request_system_boot(line.port, 120s), "");
  node.join();
  ::close(line.held);
  EXPECT_EQ(heard, "DFU");
}

TEST(ConsoleRequest, TellsWhyItIsRefused) {
  Line line;
  std::thread node([&] {
    line.hear();
    const std::string answer = "refused: an axis has power\r\n";
    EXPECT_EQ(::write(line.fd, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
  });
  EXPECT_EQ(request_system_boot(line.port, 120s), "the node refused: an axis has power");
  node.join();
  ::close(line.held);
  ::close(line.fd);
}

TEST(ConsoleRequest, NamesThePortThatIsNotThere) {
  EXPECT_EQ(request_system_boot("/nowhere/ttyACM0"), "/nowhere/ttyACM0: No such file or directory");
}

}  // namespace
}  // namespace kinebus
