#pragma once
// A print host as hosts are written (numbers, checksums, one line under way, Resend), on a line with noise,
// before a session on the whole machine in virtual time.

#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "gateway/machine/tests/machine_rig.hpp"
#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {

class MemoryFiles : public SerialFiles {
 public:
  explicit MemoryFiles(Gateway& gateway) : gateway_(gateway) {}
  void list(const Asked& answer) override {
    for (const auto& [name, text] : texts) answer->entries.push_back({name, text.size()});
    finish(answer, {});
  }
  void size(const Asked& answer, std::string_view name) override {
    const auto found = texts.find(std::string(name));
    if (found == texts.end()) return finish(answer, "no such job");
    answer->entries.push_back({found->first, found->second.size()});
    finish(answer, {});
  }
  void run(const Asked& answer, std::string_view name) override {
    const auto found = texts.find(std::string(name));
    if (found == texts.end()) return finish(answer, "no such job");
    const auto begun =
        gateway_.carry_out(command::Run{std::make_unique<StringSource>(found->second), std::string(name)});
    finish(answer, begun ? std::string() : std::string(begun.error().words));
  }
  void remove(const Asked& answer, std::string_view name) override {
    finish(answer, texts.erase(std::string(name)) > 0 ? "" : "no such job");
  }
  void store(const Asked& answer, std::string_view name, std::string text) override {
    texts[std::string(name)] = std::move(text);
    finish(answer, {});
  }
  /// While the disk is `slow`, what was asked is answered here.
  void answer_late() {
    for (const Asked& answer : late_) answer->done = true;
    late_.clear();
  }
  bool slow = false;
  std::map<std::string, std::string> texts;

 private:
  void finish(const Asked& answer, std::string refused) {
    answer->refused = std::move(refused);
    answer->done = !slow;
    if (slow) late_.push_back(answer);
  }
  std::vector<Asked> late_;
  Gateway& gateway_;
};

class SerialRig {
 public:
  using Clock = std::chrono::nanoseconds;
  explicit SerialRig(double noise_per_line = 0, std::uint64_t seed = 1,
                     MachineDescription description = default_m1())
      : machine(std::move(description)),
        files(*machine.gateway),
        session(*machine.gateway, files, {.control = &control}),
        noise_(noise_per_line),
        random_(seed) {
    turn();
  }

  /// One turn: the session's news are read, and given the time.
  void turn() {
    for (; told_ < machine.events.size(); ++told_) session.on_event(machine.events[told_]);
    session.on_time(machine.now);
    const auto bytes = session.next_bytes();
    heard_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    session.on_bytes_sent(bytes.size());
    for (std::size_t end = heard_.find('\n'); end != std::string::npos; end = heard_.find('\n')) {
      answers.push_back(heard_.substr(0, end));
      heard_.erase(0, end + 1);
      hear(answers.back());
    }
  }
  bool until(const std::function<bool()>& done, BusTime limit) {
    return machine.run_until([&] { return turn(), done(); }, limit);
  }
  void write(std::string_view text) {
    session.on_bytes(machine.now, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// Sends a line without number and waits for its "ok"; what came before it, one a line.
  std::string ask(const std::string& line, BusTime limit = std::chrono::seconds{200}) {
    const std::size_t first = answers.size();
    const std::size_t oks = oks_;
    write(line + "\n");
    if (!until([&] { return oks_ > oks; }, limit)) return "no ok";
    std::string text;
    for (std::size_t i = first; i < answers.size(); ++i)
      if (answers[i].rfind("ok", 0) != 0 || answers[i].size() > 20) text += answers[i] + "\n";
    return text;
  }
  /// Prints a text as printcore does. `pause`: between two lines now and then.
  bool print(const std::string& text, BusTime limit, BusTime pause = BusTime{0}) {
    std::istringstream in(text);
    lines_.clear();
    for (std::string line; std::getline(in, line);)
      if (line.find_first_not_of(" \r") != std::string::npos && line[0] != ';') lines_.push_back(line);
    next_ = -1;
    printing_ = clear_ = true;
    pause_ = pause;
    const bool done = until(
        [&] {
          if (clear_ && next_ < static_cast<long>(lines_.size()) && machine.now >= resume_at_) send();
          return clear_ && next_ >= static_cast<long>(lines_.size());
        },
        limit);
    printing_ = false;
    return done && until([&] { return machine.gateway->state() == MachineState::kReady; }, limit);
  }
  std::size_t oks() const { return oks_; }
  bool said(std::string_view words) const {
    for (const std::string& answer : answers)
      if (answer.find(words) != std::string::npos) return true;
    return false;
  }
  std::string log() const {
    std::string text;
    const std::size_t first = answers.size() > 40 ? answers.size() - 40 : 0;
    for (std::size_t i = first; i < answers.size(); ++i) text += answers[i] + "\n";
    return text + machine.story();
  }

  MachineRig machine;
  MemoryFiles files;
  Control control;
  MarlinSession session;
  std::vector<std::string> answers;
  std::uint64_t damaged = 0;

 private:
  void hear(const std::string& answer) {
    if (answer.rfind("ok", 0) == 0) {
      ++oks_;
      clear_ = true;
    }
    if (printing_ && answer.rfind("Resend: ", 0) == 0) {
      next_ = std::stol(answer.substr(8));
      clear_ = true;
    }
  }
  void send() {
    std::string line =
        "N" + std::to_string(next_) + " " + (next_ < 0 ? "M110" : lines_[static_cast<std::size_t>(next_)]);
    unsigned sum = 0;
    for (const char c : line) sum ^= static_cast<unsigned char>(c);
    line += "*" + std::to_string(sum) + "\n";
    std::uniform_real_distribution<double> chance(0, 1);
    if (next_ >= 0 && chance(random_) < noise_) {
      ++damaged;
      char& hit = line[random_() % line.size()];
      hit = static_cast<char>(hit ^ static_cast<char>(1u << (random_() % 7)));
    }
    ++next_;
    clear_ = false;
    if (pause_ > BusTime{0} && random_() % 8 == 0) resume_at_ = machine.now + pause_;
    write(line);
  }

  std::string heard_;
  std::size_t told_ = 0, oks_ = 0;
  double noise_;
  std::mt19937_64 random_;
  std::vector<std::string> lines_;
  long next_ = 0;
  bool printing_ = false, clear_ = true;
  BusTime pause_{0}, resume_at_{0};
};

}  // namespace kinebus
