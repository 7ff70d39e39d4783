#pragma once
// Boards with the real node cores on a bus in virtual time, a machine around them that is wired in a way of
// its own, and a person who looks at it and answers.

#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "node_firmware/core/node.hpp"
#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/port/host/heat_plant.hpp"
#include "protocol/canopen/boards/all.hpp"
#include "tools/flash/program_update.hpp"
#include "tools/machine_setup/tests/flash_board.hpp"
#include "tools/machine_setup/walk.hpp"

namespace kinebus {

/// A frame takes 130 us. Boards without an id have stored none yet.
class SetupRig {
 public:
  struct AxisBoard {
    NodeOptions options{};
    std::unique_ptr<LoneNode> node{};
    std::vector<std::uint8_t> flash{};
    std::array<double, 2> first_move{};  ///< counts: where each motor went first, since it was looked at
    std::array<std::uint32_t, 2> moves{};
  };
  /// What a person sees: the joint whose motor is there, and whether it is mounted the other way round.
  struct Wire {
    std::string joint;
    bool mirrored = false;
  };
  using Socket = std::pair<std::size_t, int>;  ///< board, axis

  SetupRig() {
    folder_ = std::filesystem::temp_directory_path() / ("setup_rig_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~SetupRig() { std::filesystem::remove_all(folder_); }
  SetupRig(const SetupRig&) = delete;
  SetupRig& operator=(const SetupRig&) = delete;

  void add_board(const BoardFacts& facts, std::uint32_t serial, std::uint8_t node_id = 0,
                 std::uint8_t consecutive = 1) {
    AxisBoard board;
    board.options = {.identity = {.product_code = facts.product_code, .serial = serial},
                     .node_id = node_id,
                     .consecutive_ids = consecutive};
    board.node = std::make_unique<LoneNode>(board.options, now_);
    boards.push_back(std::move(board));
  }
  void add_heat(std::uint8_t node_id, bool max31865 = true) {
    heat = std::make_unique<heat::HeatNode>(
        heat::HeatNodeOptions{
            .node_id = node_id, .serial = 77, .max31865 = max31865 ? std::uint8_t{1} : std::uint8_t{0}},
        now_);
  }

  SetupHost host() {
    return {.bus = {.send = [this](const CanFrame& frame) { tell_all(frame, nullptr, false); },
                    .receive = [this](LocalTime until) { return receive(until); },
                    .now = [this] { return now_; }},
            .io = {.read_line = [this] { return answer(); },
                   .print = [this](std::string_view words) { said.append(words), question_.append(words); }},
            .interrupted = [this] { return interrupted && interrupted(); },
            .flash =
                [this](const std::string& image, const std::vector<std::uint8_t>& nodes, bool other_kind) {
                  flashed.emplace_back(image, nodes);
                  return ebbs.empty() || write_program(image, nodes, other_kind);
                },
            .usb = {},
            .programs = programs};
  }
  int walk(const std::string& name = "machine.toml", bool anew = false) {
    SetupHost world = host();
    WalkOptions options;
    options.file = folder_ / name;
    options.anew = anew;
    return kinebus::walk(world, options);
  }
  std::filesystem::path file(const std::string& name = "machine.toml") const { return folder_ / name; }
  std::string text(const std::string& name = "machine.toml") const {
    std::ifstream in(file(name));
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }

  /// All motors without power, all heaters off, a control period of the heaters later.
  bool dark() {
    constexpr LocalTime kPeriod = std::chrono::milliseconds{200};
    for (const LocalTime end = now_ + kPeriod; now_ < end;) static_cast<void>(receive(end));
    for (const AxisBoard& board : boards)
      for (const int axis : {0, 1})
        if (board.node->drive(axis).power) return false;
    for (int i = 0; heat && i < kHeaters; ++i)
      if (heat->heater_output(i) != 0) return false;
    return true;
  }

  /// A file for --programs, beside the machine file.
  void add_program(const std::string& name, const std::vector<std::uint8_t>& image) {
    programs = folder_;
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  }
  FlashBoard& add_ebb(std::uint32_t serial) {
    return *ebbs.emplace_back(std::make_unique<FlashBoard>(serial, now_));
  }
  LocalTime now() const { return now_; }

  std::vector<AxisBoard> boards;
  std::vector<std::unique_ptr<FlashBoard>> ebbs;
  std::filesystem::path programs;
  std::unique_ptr<heat::HeatNode> heat;
  heat::HeatPlant plant;
  std::map<Socket, Wire> wires;
  /// Answers to a question that has these words; the longest words count. A list is used up from its
  /// beginning, its last answer stays.
  std::map<std::string, std::deque<std::string>> answers;
  /// What the person does when asked for a press: board, input (0 ..), level while it is pressed.
  struct Press {
    std::size_t board;
    int input;
    bool level;
    bool early = false;  ///< it is pressed already when it is asked for, and let go in the end
  };
  std::map<std::string, std::deque<Press>> presses;  ///< by the joint's name, or "Probe"
  bool is_octopus = false;  ///< its nodes see the same stops, each from its own on, and the same probe
  std::function<bool()> interrupted;
  std::function<void(std::string_view)> on_question;  ///< what happens at the boards meanwhile
  std::string said;
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> flashed;
  int questions = 0, most_questions = 500;

 private:
  std::optional<std::string> answer() {
    const std::string question = std::exchange(question_, {});
    if (on_question) on_question(question);
    if (++questions > most_questions) return std::nullopt;
    if (question.find("What moved first?") != std::string::npos) return look();
    if (question.find("Which joint moved?") != std::string::npos) return moved_;
    if (question.find("it is pressed within") != std::string::npos) plan_press(question);
    if (question.find("it moves now") != std::string::npos)
      asked_ = question.substr(question.rfind("\n", question.find(": first ")) + 1);
    std::deque<std::string>* best = nullptr;
    std::size_t longest = 0;
    for (auto& [words, list] : answers)
      if (question.find(words) != std::string::npos && words.size() >= longest && !list.empty())
        best = &list, longest = words.size();
    if (best == nullptr) return "";  // what is usual
    const std::string text = best->front();
    if (best->size() > 1) best->pop_front();
    return text;
  }

  /// Which motor went, and which way, as it is wired; forgotten then.
  std::string look() {
    std::string words = "nothing";
    const std::string joint = asked_.substr(0, asked_.find(':'));
    for (std::size_t b = 0; b < boards.size(); ++b)
      for (const int axis : {0, 1}) {
        const double went = std::exchange(boards[b].first_move[static_cast<std::size_t>(axis)], 0);
        const auto wire = wires.find({b, axis});
        if (went == 0 || wire == wires.end()) continue;
        moved_ = wire->second.joint;
        std::transform(moved_.begin(), moved_.end(), moved_.begin(),
                       [](unsigned char c) { return std::tolower(c); });
        words = wire->second.joint != joint           ? "another"
                : (went > 0) != wire->second.mirrored ? "yes"
                                                      : "inverted";
      }
    return words;
  }

  void plan_press(const std::string& question) {
    for (auto& [name, list] : presses)
      if (question.find(name + ":") != std::string::npos && !list.empty()) {
        press_ = list.front();
        if (press_->early) set_pin(*press_, press_->level);
        press_at_ = now_ + std::chrono::seconds{2};
        if (list.size() > 1) list.pop_front();
      }
  }

  void set_pin(const Press& press, bool level) {
    constexpr int kProbe = 6, kStops = 8;
    const int stop = 2 * static_cast<int>(press.board) + press.input;
    for (std::size_t b = 0; b < boards.size(); ++b) {
      const int place = (stop + kStops - 2 * static_cast<int>(b)) % kStops;
      const int input = press.input == kProbe ? kProbe : place;
      if (b == press.board || (is_octopus && input <= kProbe && (input < kProbe || press.input == kProbe)))
        boards[b].node->on_switch(now_, b == press.board ? press.input : input, level);
    }
  }

  /// As kinebus-flash does.
  bool write_program(const std::string& file, const std::vector<std::uint8_t>& nodes, bool other_kind) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(in), {}};
    bool good = true;
    for (const std::uint8_t node : nodes) {
      ProgramUpdate work(node, image, now_, {.answer = std::chrono::seconds{1}, .other_kind = other_kind});
      while (work.status() == ProgramUpdate::Status::kBusy) {
        while (const auto frame = work.next_frame()) tell_all(*frame, nullptr, false);
        if (const auto frame = receive(std::min(work.next_deadline(), now_ + std::chrono::milliseconds{1})))
          work.on_frame(now_, *frame);
        work.on_time(now_);
      }
      said += "node " + std::to_string(node) + ": " + work.message() + "\n";
      good = good && work.status() == ProgramUpdate::Status::kDone;
    }
    return good;
  }

  void tell_all(const CanFrame& frame, const Node* but, bool from_heat) {
    for (const auto& ebb : ebbs)
      if (ebb.get() != speaking_) ebb->on_frame(now_, frame);
    for (AxisBoard& board : boards)
      if (board.node.get() != but) board.node->on_frame(now_, frame);
    if (heat && !from_heat) heat->on_frame(now_, frame);
  }

  void step() {
    constexpr LocalTime kPressed = std::chrono::seconds{1};
    if (press_ && now_ >= press_at_) {
      const bool over = now_ >= press_at_ + kPressed;
      set_pin(*press_, (over || press_->early) != press_->level);
      if (over) press_.reset();
    }
    for (AxisBoard& board : boards) {
      board.node->on_time(now_);
      if (const auto image = board.node->image_to_store(); !image.empty()) {
        board.flash.assign(image.begin(), image.end());
        board.node->on_image_stored(true);
      }
      for (const int axis : {0, 1}) {
        double& first = board.first_move[static_cast<std::size_t>(axis)];
        const double at = static_cast<double>(board.node->position(now_, axis)) / 4294967296.0;
        if (first == 0 && std::abs(at) > 100) first = at;
      }
    }
    for (const auto& ebb : ebbs) ebb->on_time(now_);
    if (!heat) return;
    for (; sampled_ <= now_; sampled_ += heat::HeatPlant::kPeriod) plant.step(*heat, sampled_);
    heat->on_time(now_);
  }

  std::optional<CanFrame> receive(LocalTime until) {
    for (;; now_ += std::chrono::milliseconds{1}) {
      step();
      for (AxisBoard& board : boards)
        if (const auto frame = board.node->next_frame()) {
          tell_all(*frame, board.node.get(), false);
          now_ += std::chrono::microseconds{130};
          return frame;
        }
      for (const auto& ebb : ebbs)
        if (const auto frame = ebb->next_frame(now_)) {
          speaking_ = ebb.get();
          tell_all(*frame, nullptr, false);
          speaking_ = nullptr;
          now_ += std::chrono::microseconds{130};
          return frame;
        }
      if (heat)
        if (const auto frame = heat->next_frame()) {
          tell_all(*frame, nullptr, true);
          now_ += std::chrono::microseconds{130};
          return frame;
        }
      if (now_ >= until) return std::nullopt;
    }
  }

  std::filesystem::path folder_;
  LocalTime now_{std::chrono::seconds{1}}, sampled_{std::chrono::seconds{1}}, press_at_{0};
  const FlashBoard* speaking_ = nullptr;
  std::optional<Press> press_;
  std::string question_, asked_, moved_;
};

}  // namespace kinebus
