#include "gateway/sessions/control.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {

ClientId Control::attach(std::string name, std::string transport) {
  clients_.push_back({++last_, std::move(name), std::move(transport)});
  return last_;
}

void Control::detach(ClientId client) {
  release(client);
  std::erase_if(clients_, [&](const Client& c) { return c.id == client; });
}

bool Control::take(ClientId client, bool force) {
  if (client == 0 || (holder_ != 0 && holder_ != client && !force)) return false;
  holder_ = client;
  return true;
}

void Control::release(ClientId client) {
  if (holder_ == client) holder_ = 0;
}

bool Control::hand_over(ClientId from, ClientId to) {
  const bool known =
      std::any_of(clients_.begin(), clients_.end(), [&](const Client& c) { return c.id == to; });
  if (holder_ != from || from == 0 || !known) return false;
  holder_ = to;
  return true;
}

std::string Control::name_of(ClientId client) const {
  for (const Client& c : clients_)
    if (c.id == client) return c.name;
  return {};
}

}  // namespace kinebus
