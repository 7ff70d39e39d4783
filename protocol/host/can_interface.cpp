#include "protocol/host/can_interface.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace kinebus {
namespace {

constexpr std::uint32_t kBitRate = 1'000'000;
/// So many frames of one program wait in the kernel at most (the gateway's four), and as many of others.
constexpr std::uint32_t kFewestQueued = 8;

using Bytes = std::span<const std::uint8_t>;

/// nullopt: shorter than a T.
template <typename T>
std::optional<T> front_of(Bytes bytes) {
  T value{};
  if (bytes.size() < sizeof value) return std::nullopt;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// The value of the first attribute of this type.
std::optional<Bytes> attribute(Bytes list, unsigned type) {
  while (const auto head = front_of<rtattr>(list)) {
    if (head->rta_len < sizeof(rtattr) || head->rta_len > list.size()) break;
    const Bytes value = list.subspan(sizeof(rtattr), head->rta_len - sizeof(rtattr));
    if ((head->rta_type & ~NLA_F_NESTED) == type) return value;
    list = list.subspan(std::min<std::size_t>(RTA_ALIGN(head->rta_len), list.size()));
  }
  return std::nullopt;
}

std::uint32_t number(Bytes list, unsigned type) {
  const auto value = attribute(list, type);
  return value ? front_of<std::uint32_t>(*value).value_or(0) : 0;
}

void read_controller(Bytes data, CanInterface& interface) {
  if (const auto timing = attribute(data, IFLA_CAN_BITTIMING))
    interface.bit_rate = front_of<can_bittiming>(*timing).value_or(can_bittiming{}).bitrate;
  if (const auto mode = attribute(data, IFLA_CAN_CTRLMODE))
    interface.listen_only =
        (front_of<can_ctrlmode>(*mode).value_or(can_ctrlmode{}).flags & CAN_CTRLMODE_LISTENONLY) != 0;
  interface.restart_ms = number(data, IFLA_CAN_RESTART_MS);
  interface.bus_off = number(data, IFLA_CAN_STATE) == CAN_STATE_BUS_OFF;
}

/// gs_usb has no restart of its own and refuses the whole line (before 2025 the kernel takes it, and falls at
/// the first bus-off): its adapters come back by themselves.
bool restarts_by_kernel(const CanInterface& interface) {
  return interface.driver != "gs_usb";
}

std::string settings_of(const std::string& name, const CanInterface& interface) {
  return "ip link set " + name + " down; ip link set " + name + " type can bitrate 1000000" +
         (restarts_by_kernel(interface) ? " restart-ms 100" : "") + "; ip link set " + name + " up";
}

/// The link ends in the driver's name.
std::string driver_of(const std::string& name) {
  std::error_code none;
  return std::filesystem::read_symlink("/sys/class/net/" + name + "/device/driver", none).filename().string();
}

}  // namespace

std::optional<CanInterface> read_link(Bytes message) {
  const auto head = front_of<nlmsghdr>(message);
  if (!head || head->nlmsg_type != RTM_NEWLINK || head->nlmsg_len > message.size() ||
      head->nlmsg_len < NLMSG_LENGTH(sizeof(ifinfomsg)))
    return std::nullopt;
  const Bytes body = message.subspan(NLMSG_HDRLEN, head->nlmsg_len - NLMSG_HDRLEN);
  const Bytes list = body.subspan(std::min<std::size_t>(NLMSG_ALIGN(sizeof(ifinfomsg)), body.size()));
  CanInterface interface;
  interface.up = (front_of<ifinfomsg>(body)->ifi_flags & IFF_UP) != 0;
  interface.transmit_queue = number(list, IFLA_TXQLEN);
  const auto info = attribute(list, IFLA_LINKINFO);
  if (!info) return interface;
  if (const auto kind = attribute(*info, IFLA_INFO_KIND))
    interface.kind.assign(reinterpret_cast<const char*>(kind->data()),
                          strnlen(reinterpret_cast<const char*>(kind->data()), kind->size()));
  const auto data = attribute(*info, IFLA_INFO_DATA);
  if (data && interface.kind == "can") read_controller(*data, interface);
  return interface;
}

std::optional<CanInterface> ask_kernel(const std::string& name) {
  struct {
    nlmsghdr head;
    ifinfomsg body;
  } request{};
  request.head.nlmsg_len = NLMSG_LENGTH(sizeof request.body);
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.body.ifi_index = static_cast<int>(if_nametoindex(name.c_str()));
  if (request.body.ifi_index == 0) return std::nullopt;
  const int fd = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (fd < 0) return std::nullopt;
  const timeval patience{.tv_sec = 1, .tv_usec = 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::array<std::uint8_t, 32768> answer{};
  ssize_t count = -1;
  if (::send(fd, &request, request.head.nlmsg_len, 0) > 0)
    count = ::recv(fd, answer.data(), answer.size(), 0);
  ::close(fd);
  if (count <= 0) return std::nullopt;
  auto interface = read_link(Bytes(answer).first(static_cast<std::size_t>(count)));
  if (interface) interface->driver = driver_of(name);
  return interface;
}

std::string obstacle(const std::string& name, const CanInterface& interface) {
  if (interface.kind != "can") return {};
  if (interface.bit_rate != 0 && interface.bit_rate != kBitRate)
    return "CAN interface " + name + " is set to " + std::to_string(interface.bit_rate) +
           " bit/s, and every node speaks 1000000: " + settings_of(name, interface);
  if (interface.listen_only)
    return "CAN interface " + name + " only listens: ip link set " + name + " down; ip link set " + name +
           " type can listen-only off; ip link set " + name + " up";
  return {};
}

std::vector<std::string> advice(const std::string& name, const CanInterface& interface) {
  std::vector<std::string> words;
  const bool controller = interface.kind == "can";
  if (!interface.up)
    words.push_back("CAN interface " + name + " is down: " +
                    (controller ? settings_of(name, interface) : "ip link set " + name + " up"));
  if (controller && interface.up && interface.restart_ms == 0 && restarts_by_kernel(interface))
    words.push_back("CAN interface " + name +
                    " stays off after a bus-off (restart-ms is 0), and the machine with it: " +
                    settings_of(name, interface));
  if (controller && interface.bus_off)
    words.push_back("CAN interface " + name +
                    " is bus-off: are both ends of the bus terminated, CAN high and low not exchanged, all "
                    "nodes at the same bit rate?");
  if (controller && interface.transmit_queue < kFewestQueued)
    words.push_back("CAN interface " + name + " holds only " + std::to_string(interface.transmit_queue) +
                    " frames that wait (txqueuelen): ip link set " + name + " txqueuelen 64");
  return words;
}

}  // namespace kinebus
