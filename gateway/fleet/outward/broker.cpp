#include "gateway/fleet/outward/broker.hpp"

#include <fmt/format.h>
#include <mosquitto.h>

#include <charconv>
#include <chrono>
#include <set>
#include <string_view>
#include <utility>

#include "gateway/fleet/outward/home_assistant.hpp"
#include "gateway/fleet/outward/sparkplug_node.hpp"

namespace kinebus::fleet {
namespace {

constexpr int kKeepAlive_s = 15;
constexpr int kTurn_ms = 100;
constexpr auto kAskAgain = std::chrono::seconds{1};

std::uint64_t now_ms() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

}  // namespace

/// One connection, from its will to its end.
class Broker::Connection {
 public:
  Connection(const Options& options, SparkplugNode& node)
      : options_(options), node_(node), client_(mosquitto_new(nullptr, true, this)) {
    if (client_ == nullptr) throw std::bad_alloc();
    mosquitto_connect_callback_set(client_, [](mosquitto*, void* self, int refused) {
      static_cast<Connection*>(self)->up_ = refused == 0;
    });
    mosquitto_message_callback_set(client_, [](mosquitto*, void* self, const mosquitto_message* message) {
      auto& connection = *static_cast<Connection*>(self);
      const std::string_view payload(static_cast<const char*>(message->payload),
                                     static_cast<std::size_t>(message->payloadlen));
      connection.rebirth_ = connection.rebirth_ || connection.node_.is_rebirth(payload);
    });
    if (!options.user.empty())
      mosquitto_username_pw_set(client_, options.user.c_str(), options.password.c_str());
    node_.next_connection();
    const MqttMessage will = node_.death(now_ms());
    mosquitto_will_set(client_, will.topic.c_str(), static_cast<int>(will.payload.size()),
                       will.payload.data(), will.qos, will.retain);
  }
  ~Connection() { mosquitto_destroy(client_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool open() {
    return mosquitto_connect(client_, options_.host.c_str(), options_.port, kKeepAlive_s) == MOSQ_ERR_SUCCESS;
  }
  /// False: the connection is over.
  bool turn(Broker& broker) {
    if (mosquitto_loop(client_, kTurn_ms, 1) != MOSQ_ERR_SUCCESS) return false;
    if (!up_) return true;
    if (!told_ || std::exchange(rebirth_, false)) {
      begin(broker);
      return true;
    }
    for (const MachineView& view : broker.changed()) {
      send(node_.show(now_ms(), view));
      show_home_assistant(view);
    }
    return true;
  }
  /// A will is told by the broker only of who vanishes: who goes says it.
  void close() {
    if (!up_) return;
    send(node_.death(now_ms()));
    mosquitto_disconnect(client_);
    mosquitto_loop(client_, kTurn_ms, 1);
  }

 private:
  void begin(Broker& broker) {
    told_ = true;
    mosquitto_subscribe(client_, nullptr, node_.command_topic().c_str(), 1);
    static_cast<void>(broker.changed());
    const std::vector<MachineView> views = broker.all();
    for (const MqttMessage& message : node_.birth(now_ms(), views)) send(message);
    for (const MachineView& view : views) show_home_assistant(view);
  }
  void show_home_assistant(const MachineView& view) {
    if (described_.insert(view.machine.name).second)
      send(home_assistant_device(options_.group, view.machine));
    send(home_assistant_state(options_.group, view));
  }
  void send(const MqttMessage& message) {
    mosquitto_publish(client_, nullptr, message.topic.c_str(), static_cast<int>(message.payload.size()),
                      message.payload.data(), message.qos, message.retain);
  }

  const Options& options_;
  SparkplugNode& node_;
  mosquitto* client_;
  std::set<std::string> described_;  ///< machines
  bool up_ = false, told_ = false, rebirth_ = false;
};

Broker::Broker(Options options) : options_(std::move(options)), thread_([this] { run(); }) {}

Broker::~Broker() {
  quit_ = true;
  thread_.join();
}

void Broker::show(const MachineView& view) {
  const std::lock_guard lock(busy_);
  views_[view.machine.name] = view;
  changed_[view.machine.name] = true;
}

std::vector<MachineView> Broker::all() {
  const std::lock_guard lock(busy_);
  std::vector<MachineView> views;
  for (const auto& [name, view] : views_) views.push_back(view);
  return views;
}

std::vector<MachineView> Broker::changed() {
  const std::lock_guard lock(busy_);
  std::vector<MachineView> views;
  for (const auto& [name, changed] : changed_) views.push_back(views_[name]);
  changed_.clear();
  return views;
}

void Broker::run() {
  mosquitto_lib_init();
  SparkplugNode node(options_.group, options_.node, now_ms() / 1000);
  bool told = false;
  while (!quit_) {
    Connection connection(options_, node);
    const bool open = connection.open();
    if (!open && !std::exchange(told, true))
      fmt::print(stderr, "broker {}:{}: does not answer\n", options_.host, options_.port);
    while (open && !quit_ && connection.turn(*this)) told = false;
    connection.close();
    for (auto waited = std::chrono::milliseconds{0}; !quit_ && waited < kAskAgain;
         waited += std::chrono::milliseconds{kTurn_ms})
      std::this_thread::sleep_for(std::chrono::milliseconds{kTurn_ms});
  }
  mosquitto_lib_cleanup();
}

std::string read_broker_address(const std::string& text, Broker::Options& options) {
  const std::size_t colon = text.rfind(':');
  options.host = text.substr(0, colon);
  if (options.host.empty()) return "expected HOST or HOST:PORT";
  if (colon == std::string::npos) return {};
  const std::string_view port = std::string_view(text).substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), options.port);
  if (error != std::errc() || end != port.data() + port.size() || options.port < 1 || options.port > 65535)
    return "expected a port of 1 to 65535 behind the colon";
  return {};
}

}  // namespace kinebus::fleet
