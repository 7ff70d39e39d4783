#include "gateway/io/mdns/announcer.hpp"

#include <avahi-client/client.h>
#include <avahi-client/publish.h>
#include <avahi-common/alternative.h>
#include <avahi-common/domain.h>
#include <avahi-common/error.h>
#include <avahi-common/malloc.h>
#include <avahi-common/thread-watch.h>
#include <avahi-common/timeval.h>
#include <spdlog/spdlog.h>

#include <initializer_list>
#include <utility>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

/// So long after the daemon or the bus is found missing it is looked for again.
constexpr unsigned kAgainMs = 3000;

/// All but the constructor and the destructor runs on avahi's thread.
struct Avahi {
  explicit Avahi(Announcer::Options given) : options(std::move(given)) {
    options.name = shown(options.name, AVAHI_LABEL_MAX - 1);
    poll = avahi_threaded_poll_new();
    if (poll == nullptr) return;
    api = avahi_threaded_poll_get(poll);
    // Even the first step talks to the bus, which may hang.
    const timeval at_once{};
    again = api->timeout_new(api, &at_once, connect, this);
    started = avahi_threaded_poll_start(poll) == 0;
  }
  ~Avahi() {
    if (poll == nullptr) return;
    if (started) avahi_threaded_poll_stop(poll);
    if (client != nullptr) avahi_client_free(client);
    api->timeout_free(again);
    avahi_threaded_poll_free(poll);
  }
  Avahi(const Avahi&) = delete;
  Avahi& operator=(const Avahi&) = delete;

  static void connect(AvahiTimeout*, void* data) {
    Avahi& self = *static_cast<Avahi*>(data);
    self.api->timeout_update(self.again, nullptr);
    // The group goes with its client.
    if (self.client != nullptr) avahi_client_free(self.client);
    self.group = nullptr;
    self.client = nullptr;
    int error = 0;
    self.client = avahi_client_new(self.api, AVAHI_CLIENT_NO_FAIL, on_client, data, &error);
    if (self.client == nullptr) self.connect_again(avahi_strerror(error));
  }

  void connect_again(const char* why) {
    if (!missed) spdlog::info("mDNS: not announced ({}); tried again until it is", why);
    missed = true;
    timeval then{};
    avahi_elapse_time(&then, kAgainMs, 0);
    api->timeout_update(again, &then);
  }

  static void on_client(AvahiClient* client, AvahiClientState state, void* data) {
    Avahi& self = *static_cast<Avahi*>(data);
    // Called within avahi_client_new(), too.
    self.client = client;
    if (state == AVAHI_CLIENT_S_RUNNING) self.announce();
    // This computer gets its own name, or another one: all is told anew when it has it.
    if ((state == AVAHI_CLIENT_S_COLLISION || state == AVAHI_CLIENT_S_REGISTERING) && self.group != nullptr)
      avahi_entry_group_reset(self.group);
    if (state == AVAHI_CLIENT_FAILURE) self.connect_again(avahi_strerror(avahi_client_errno(client)));
  }

  static void on_group(AvahiEntryGroup* group, AvahiEntryGroupState state, void* data) {
    Avahi& self = *static_cast<Avahi*>(data);
    self.group = group;
    if (state == AVAHI_ENTRY_GROUP_ESTABLISHED) {
      self.missed = false;
      spdlog::info("mDNS: announced as {}", self.options.name);
    }
    if (state == AVAHI_ENTRY_GROUP_COLLISION) {
      self.take_another_name();
      self.announce();
    }
    if (state == AVAHI_ENTRY_GROUP_FAILURE)
      self.connect_again(avahi_strerror(avahi_client_errno(self.client)));
  }

  void take_another_name() {
    char* other = avahi_alternative_service_name(options.name.c_str());
    options.name = other;
    avahi_free(other);
  }

  int add(const char* type, std::initializer_list<std::string> texts) {
    AvahiStringList* list = nullptr;
    for (const std::string& text : texts) list = avahi_string_list_add(list, text.c_str());
    const int error = avahi_entry_group_add_service_strlst(group, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC,
                                                           AvahiPublishFlags{}, options.name.c_str(), type,
                                                           nullptr, nullptr, options.port, list);
    avahi_string_list_free(list);
    return error;
  }

  /// All services under one name.
  int add_all() {
    // Cura's plug-in asks for "useHttps"; OctoPrint itself tells of path, version and the version of its API.
    if (const int error =
            add("_octoprint._tcp", {"path=/", "version=" + options.octoprint, "api=0.1", "useHttps=true"});
        error != 0)
      return error;
    if (const int error = add("_prusalink._tcp", {"path=/"}); error != 0) return error;
    if (const int error = add("_kinebus._tcp", {"path=/kinebus/v1", "version=" + options.version});
        error != 0)
      return error;
    return add("_https._tcp", {"path=/"});
  }

  void announce() {
    if (group == nullptr) group = avahi_entry_group_new(client, on_group, this);
    if (group == nullptr) return connect_again(avahi_strerror(avahi_client_errno(client)));
    // What was there before the daemon was told of another name of this computer is gone already.
    int error = 0;
    do {
      avahi_entry_group_reset(group);
      error = add_all();
      if (error == AVAHI_ERR_COLLISION) take_another_name();
    } while (error == AVAHI_ERR_COLLISION);
    if (error == 0) error = avahi_entry_group_commit(group);
    if (error != 0) connect_again(avahi_strerror(error));
  }

  Announcer::Options options;
  AvahiThreadedPoll* poll = nullptr;
  const AvahiPoll* api = nullptr;
  AvahiTimeout* again = nullptr;
  AvahiClient* client = nullptr;
  AvahiEntryGroup* group = nullptr;
  bool started = false;
  bool missed = false;  ///< and said so
};

}  // namespace

bool Announcer::built_in() {
  return true;
}
Announcer::Announcer(Options options) : avahi_(std::make_shared<Avahi>(std::move(options))) {}
Announcer::~Announcer() = default;

}  // namespace kinebus
