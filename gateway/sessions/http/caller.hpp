#pragma once
// Asks the machine's handlers and the store for a client, and hears what they answer: what a connection of
// HTTP and a websocket have in common.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/requester.hpp"

namespace kinebus::http {

class Caller : public Requester {
 public:
  /// `server` must outlive it.
  Caller(Server& server, LocalTime now);
  ~Caller() override;

  ClientId client() const override { return client_; }
  void take_reply(joblink::Reply reply) override;

  Server& server() { return server_; }
  LocalTime now() const { return now_; }
  std::uint64_t id() const { return id_; }

  /// Who is asking, and so what is carried out. Nobody may ask for anything.
  void become(Visitor visitor) { visitor_ = std::move(visitor); }
  const Visitor& visitor() const { return visitor_; }
  Role role() const { return visitor_.role; }

  using Then = std::function<void(const joblink::Reply&)>;
  /// A request as the job link knows it; `then` is called with its reply unless it is not awaited any more.
  void ask(const joblink::ClientMessage& message, Then then);
  /// The same of what may change the machine.
  virtual void command(const joblink::ClientMessage& message, Then then) { ask(message, std::move(then)); }
  /// The same of what is answered at once.
  joblink::Reply ask_now(const joblink::ClientMessage& message);
  /// `work` beside the loop, with the store; `then` takes what it returns.
  template <typename Work, typename Done>
  void beside(Work work, Done then) {
    server_.worker().ask([&store = server_.store(), work = std::move(work)] { return work(store); },
                         [awaited = std::weak_ptr<int>(awaited_), then = std::move(then)](auto found) {
                           if (const auto count = awaited.lock()) {
                             --*count;
                             then(std::move(found));
                           }
                         });
    ++*awaited_;
  }
  /// By the role of its last request, and control.
  ByteSession::Rank rank_of_client() const;
  /// Asks `look` now and then until it answers true.
  void wait_for(std::function<bool(LocalTime)> look);

 protected:
  /// The client that calls itself `name` is among those who may command; "": "HTTP client".
  void attach(std::string_view name, const std::string& transport);
  void detach();
  /// Who has not this role hears so. True: that has been said.
  bool is_refused(Role needed, const Then& then) const;
  /// The number of a request that `then` is to hear of.
  std::uint32_t expect(Then then);
  /// What is asked for beside the loop now.
  int asked_beside() const { return *awaited_; }
  /// Nothing that was asked for is awaited any more.
  void forget_asked();
  void look(LocalTime now);
  LocalTime next_look() const { return looks_.empty() ? LocalTime::max() : next_look_; }

  Server& server_;
  LocalTime now_;

 private:
  std::uint64_t id_;
  Visitor visitor_;
  ClientId client_ = 0;
  std::map<std::uint32_t, Then> expected_;
  std::uint32_t last_request_ = 0;
  std::vector<std::function<bool(LocalTime)>> looks_;
  LocalTime next_look_{0};
  std::shared_ptr<int> awaited_ = std::make_shared<int>(0);
};

}  // namespace kinebus::http
