#include "gateway/io/usb/function_fs.hpp"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "gateway/io/usb/usb_descriptors.hpp"

namespace kinebus {
namespace {

constexpr LocalTime kOpenRetry = std::chrono::milliseconds{500};

bool write_all(int fd, const std::vector<std::uint8_t>& bytes) {
  return ::write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace

FunctionFs::FunctionFs(EventLoop& loop, StreamHub& hub, std::string folder, NewSession new_session)
    : loop_(loop), hub_(hub), folder_(std::move(folder)), new_session_(std::move(new_session)) {}

FunctionFs::~FunctionFs() {
  close();
}

bool FunctionFs::open() {
  const auto open_file = [&](const char* name) {
    return ::open((folder_ + "/" + name).c_str(), O_RDWR | O_CLOEXEC | (name[2] == '0' ? O_NONBLOCK : 0));
  };
  control_ = open_file("ep0");
  if (control_ < 0) return false;
  const bool told = write_all(control_, function_descriptors()) && write_all(control_, function_strings());
  if (told) {
    out_ = open_file("ep1");
    in_ = open_file("ep2");
  }
  if (!told || out_ < 0 || in_ < 0) {
    if (counters_.failures++ == 0)
      spdlog::warn("USB: FunctionFS at {} refuses: {}", folder_, std::strerror(errno));
    close();
    return false;
  }
  loop_.watch(control_, EPOLLIN, [this](std::uint32_t) { read_events(); });
  spdlog::info("USB: job link ready at {}", folder_);
  return true;
}

void FunctionFs::close() {
  disable();
  if (control_ >= 0 && in_ >= 0) loop_.forget(control_);
  for (int* fd : {&in_, &out_, &control_}) {
    if (*fd >= 0) ::close(*fd);
    *fd = -1;
  }
}

void FunctionFs::read_events() {
  std::array<usb_functionfs_event, 8> events{};
  const ssize_t bytes = ::read(control_, events.data(), sizeof events);
  if (bytes < 0) {
    if (errno == EAGAIN || errno == EINTR || errno == EIDRM) return;
    spdlog::warn("USB: the gadget is gone: {}", std::strerror(errno));
    return close();
  }
  const std::size_t count = static_cast<std::size_t>(bytes) / sizeof events[0];
  for (std::size_t i = 0; i < count && control_ >= 0; ++i) {
    switch (events[i].type) {
      case FUNCTIONFS_ENABLE:
        enable();
        break;
      case FUNCTIONFS_DISABLE:
      case FUNCTIONFS_UNBIND:
        disable();
        break;
      case FUNCTIONFS_SETUP:
        // No request is known: an answer in the wrong direction stalls it.
        if ((events[i].u.setup.bRequestType & USB_DIR_IN) != 0) {
          [[maybe_unused]] const ssize_t stalled = ::read(control_, nullptr, 0);
        } else {
          [[maybe_unused]] const ssize_t stalled = ::write(control_, nullptr, 0);
        }
        break;
      default:
        break;  // BIND; SUSPEND and RESUME: transfers wait, the session's own silence limit decides
    }
  }
}

void FunctionFs::enable() {
  disable();
  ++counters_.enabled;
  // What the connection before left in the endpoints must not reach the new one.
  ::ioctl(out_, FUNCTIONFS_FIFO_FLUSH);
  ::ioctl(in_, FUNCTIONFS_FIFO_FLUSH);
  pipe_ = std::make_shared<UsbPipe>(out_, in_);
  in_use_ = std::make_shared<bool>(false);
  spdlog::info("USB: a host has connected");
  listen();
}

void FunctionFs::disable() {
  if (!pipe_) return;
  ++counters_.disabled;
  if (listening_) loop_.forget(pipe_->fd());
  listening_ = false;
  pipe_->close();
  pipe_.reset();
  in_use_.reset();
  spdlog::info("USB: the host has gone");
}

/// Until somebody speaks there is no session: a host that only charges is none.
void FunctionFs::listen() {
  if (!pipe_ || listening_ || *in_use_ || pipe_->closed()) return;
  loop_.watch(pipe_->fd(), EPOLLIN, [this](std::uint32_t) { on_pipe(); });
  listening_ = true;
  on_pipe();
}

void FunctionFs::on_pipe() {
  if (!pipe_->has_bytes() && !pipe_->closed()) return;
  loop_.forget(pipe_->fd());
  listening_ = false;
  if (pipe_->closed()) return;
  auto session = new_session_(loop_.now());
  if (!session) {
    next_open_ = loop_.now() + kOpenRetry;
    return;
  }
  ++counters_.sessions;
  hub_.add(std::make_unique<UsbStream>(pipe_, in_use_), std::move(session));
}

void FunctionFs::on_time(LocalTime now) {
  if (control_ < 0 && now >= next_open_) {
    next_open_ = now + kOpenRetry;
    open();
  }
  if (now >= next_open_) listen();
}

LocalTime FunctionFs::next_deadline() const {
  return control_ < 0 || (pipe_ && !listening_ && !*in_use_ && !pipe_->closed()) ? next_open_
                                                                                 : LocalTime::max();
}

}  // namespace kinebus
