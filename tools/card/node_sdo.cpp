#include "tools/card/node_sdo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "protocol/bytes.hpp"
#include "protocol/canopen/abort_code.hpp"
#include "protocol/canopen/sdo_client.hpp"

namespace kinebus {
namespace {

constexpr LocalTime kAnswerPoll = std::chrono::milliseconds{20};

}  // namespace

const ObjectEntry& NodeSdo::entry_of(ObjectAddress address) const {
  const int place = table_->find(address);
  if (place < 0) throw CardError(fmt::format("no object {:04X}h:{}", address.index, address.subindex));
  return (*table_)[place];
}

template <typename Begin>
std::size_t NodeSdo::transfer(ObjectAddress address, const Begin& begin) {
  SdoClient client;
  begin(client);
  while (client.status() == SdoClient::Status::kBusy) {
    while (const auto frame = client.next_frame()) bus_.send(*frame);
    if (const auto frame = bus_.receive(std::min(client.next_deadline(), bus_.now() + kAnswerPoll)))
      client.on_frame(bus_.now(), *frame);
    client.on_time(bus_.now());
  }
  if (client.status() == SdoClient::Status::kDone) return client.received();
  if (client.abort_code() == AbortCode::kTimeout)
    throw CardError(fmt::format("node {} does not answer", node_));
  throw CardError(fmt::format("node {}, object {:04X}h:{}: {}", node_, address.index, address.subindex,
                              text(client.abort_code())));
}

std::size_t NodeSdo::upload(ObjectAddress address, std::span<std::uint8_t> room) {
  const std::size_t length =
      transfer(address, [&](SdoClient& client) { client.upload(bus_.now(), node_, address, room); });
  return std::min(length, room.size());
}

std::int64_t NodeSdo::read(ObjectAddress address) {
  const ObjectEntry& entry = entry_of(address);
  std::array<std::uint8_t, 8> room{};
  const std::size_t length = upload(address, room);
  return value_of(entry.type, get_le(room, length));
}

std::string NodeSdo::read_text(ObjectAddress address) {
  std::array<std::uint8_t, 64> room{};
  const std::size_t length = upload(address, room);
  std::string words;
  for (std::size_t i = 0; i < length; ++i)
    words += room[i] >= ' ' && room[i] < 0x7F ? static_cast<char>(room[i]) : '?';
  return words;
}

void NodeSdo::write(ObjectAddress address, std::int64_t value) {
  std::array<std::uint8_t, 8> bytes{};
  const std::size_t size = entry_of(address).size();
  put_le(bytes, static_cast<std::uint64_t>(value), size);
  transfer(address, [&](SdoClient& client) {
    client.download(bus_.now(), node_, address, std::span(bytes).first(size));
  });
}

void NodeSdo::pause(LocalTime time) {
  for (const LocalTime end = bus_.now() + time; bus_.now() < end;) static_cast<void>(bus_.receive(end));
}

}  // namespace kinebus
