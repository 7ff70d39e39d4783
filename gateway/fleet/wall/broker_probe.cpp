#include "gateway/fleet/wall/broker_probe.hpp"

#include <fmt/format.h>
#include <mosquitto.h>

#include <chrono>
#include <new>
#include <utility>

namespace kinebus::fleet {
namespace {

constexpr int kPing_s = 5;  ///< the least that libmosquitto takes
constexpr int kWaited_ms = 100;
constexpr auto kLoginWithin = std::chrono::seconds{5};
constexpr auto kLoginAgain = std::chrono::seconds{2};

}  // namespace

/// One connection. libmosquitto sends the pings, and ends it when one is not answered.
class BrokerProbe::Client {
 public:
  explicit Client(const Broker::Options& broker)
      : client_(mosquitto_new(nullptr, true, this)), login_until_(Clock::now() + kLoginWithin) {
    if (client_ == nullptr) throw std::bad_alloc();
    mosquitto_connect_callback_set(
        client_, [](mosquitto*, void* self, int refused) { static_cast<Client*>(self)->answer_ = refused; });
    if (!broker.user.empty())
      mosquitto_username_pw_set(client_, broker.user.c_str(), broker.password.c_str());
    open_ = mosquitto_connect_async(client_, broker.host.c_str(), broker.port, kPing_s) == MOSQ_ERR_SUCCESS;
  }
  ~Client() {
    if (works()) mosquitto_disconnect(client_);
    mosquitto_destroy(client_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False: the connection is over.
  bool turn() {
    open_ = open_ && mosquitto_loop(client_, kWaited_ms, 1) == MOSQ_ERR_SUCCESS &&
            (works() || Clock::now() < login_until_);
    return open_;
  }
  bool works() const { return open_ && answer_ == 0; }
  /// Of the login; nullptr: it was not refused.
  const char* refusal() const { return answer_ > 0 ? mosquitto_connack_string(answer_) : nullptr; }

 private:
  using Clock = std::chrono::steady_clock;
  mosquitto* client_;
  Clock::time_point login_until_;
  int answer_ = -1;
  bool open_ = false;
};

BrokerProbe::BrokerProbe(std::optional<Broker::Options> broker) : broker_(std::move(broker)) {
  if (broker_) thread_ = std::thread([this] { run(); });
}

BrokerProbe::~BrokerProbe() {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
}

std::optional<bool> BrokerProbe::works() const {
  const int works = works_;
  return works < 0 ? std::nullopt : std::optional(works == 1);
}

void BrokerProbe::run() {
  mosquitto_lib_init();
  bool told = false;
  while (!quit_) {
    Client client(*broker_);
    while (!quit_ && client.turn())
      if (client.works()) works_ = 1;
    works_ = 0;
    if (client.refusal() != nullptr && !std::exchange(told, true))
      fmt::print(stderr, "broker {}:{}: {}\n", broker_->host, broker_->port, client.refusal());
    const auto again = std::chrono::steady_clock::now() + kLoginAgain;
    while (!quit_ && std::chrono::steady_clock::now() < again)
      std::this_thread::sleep_for(std::chrono::milliseconds{kWaited_ms});
  }
  mosquitto_lib_cleanup();
}

}  // namespace kinebus::fleet
