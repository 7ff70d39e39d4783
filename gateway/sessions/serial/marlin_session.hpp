#pragma once
// A print host's serial line, in Marlin's dialect: Pronterface, OctoPrint, Cura, Repetier-Host work as they
// are.
//
//   bytes -> LineReader (numbers, checksums, Resend) -> lines wait -> work(): each answered by one "ok"
//
// G-code goes to the gateway line by line (Gateway::take_line): it is checked, planned with look-ahead and
// moved like a job's. "ok" comes when a line is taken, so it waits while the lead is full; of G28, G4,
// M109, M190 and M400 when they are carried out. M112, M410 and M108 are seen at once, whatever waits; a
// heater is switched off (M104 S0, M140 S0) at once while another line waits for a temperature.
//
// The host is a client like all others: it has control from its first command that changes the machine until
// it is silent or its lines are done; while another client has control it may only ask and stop.

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "gateway/machine/gateway.hpp"
#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/control.hpp"
#include "gateway/sessions/serial/line_reader.hpp"
#include "gateway/sessions/serial/serial_files.hpp"

namespace kinebus {

class MarlinSession : public ByteSession {
 public:
  struct Options {
    std::string name = "serial";            ///< shown as the job's name while lines move the machine
    std::size_t line_buffer = 16;           ///< what "ok" tells as room (B)
    LocalTime close_after{2'000'000'000};   ///< without commands the machine is given back to others
    LocalTime keep_alive{2'000'000'000};    ///< between two "busy" (M113 S)
    std::size_t longest_file = 64U << 20U;  ///< M28, bytes
    Control* control = nullptr;             ///< shared with all who may command; null: nobody else does
    std::string transport = "serial";       ///< shown to the other clients
    LocalTime gone_after{15'000'000'000};   ///< a host that says nothing for so long has gone
  };
  struct Counters {
    std::uint64_t lines = 0, resends = 0, refused = 0;
  };

  /// All must outlive the session.
  MarlinSession(Gateway& gateway, SerialFiles& files, Options options);
  MarlinSession(Gateway& gateway, SerialFiles& files) : MarlinSession(gateway, files, Options{}) {}
  ~MarlinSession() override;
  MarlinSession(const MarlinSession&) = delete;
  MarlinSession& operator=(const MarlinSession&) = delete;

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;
  std::span<const std::uint8_t> next_bytes() override;
  void on_bytes_sent(std::size_t count) override;
  bool wants_bytes() const override;
  bool ended() const override { return false; }
  void on_closed(LocalTime now, std::string_view why) override;
  /// News of the machine, whoever caused them.
  void on_event(const MachineEvent& event);

  const Counters& counters() const { return counters_; }

 private:
  /// What became of the line at the front.
  enum class Done : std::uint8_t {
    kYes,      ///< "ok"
    kSilent,   ///< answered in full already
    kWaiting,  ///< not yet: asked again as time passes
  };
  /// What the line at the front waits for, besides room.
  enum class Wait : std::uint8_t { kNone, kIdle, kHeater, kBringUp, kHoming, kClear, kTuning };

  void say(std::string_view line);
  void say_ok(const serial::Line& line);
  void see_urgent(LocalTime now, serial::Urgent what, const std::string& text);
  void work(LocalTime now);
  void report(LocalTime now);
  void watch_others();
  void stop_waiting();

  // line_codes.cpp: what a line means
  bool machine_stopped() const;  ///< by a stop or an alarm, or about to
  /// A heater is waited for, and nothing behind that moves or heats before the line that comes now.
  bool only_heat_waits() const;
  Done carry_out(const serial::Line& line);
  Done carry_out_m(const serial::Line& line, int number);
  Done to_machine(const serial::Line& line);
  Done feed(const serial::Line& line);
  Done refuse(std::string_view words);
  Done query(const serial::Line& line);
  std::string temperatures() const;

  // line_waits.cpp: lines that are answered when they are carried out
  static constexpr LocalTime kHeatReport = std::chrono::seconds{1};
  Done home(const serial::Line& line);
  Done heat_and_wait(const serial::Line& line, HeaterKind kind);
  Done measure_and_wait(const serial::Line& line);
  Done wait_over();

  // line_control.cpp: who may command
  void heard();
  void leave();
  void come_and_go();
  bool idle() const { return !mine_ && !file_runs_ && lines_.empty(); }
  bool has_control() const { return options_.control != nullptr && options_.control->holder() == client_; }
  bool may_command();
  std::string no_control() const;

  // file_codes.cpp: M20 to M32, M524
  Done file_code(const serial::Line& line, int number);
  /// nullptr: the disk has not answered yet, the line waits.
  template <typename Ask>
  SerialFiles::Asked asked(const Ask& ask);
  Done select_file(const std::string& name, bool start);
  Done start_file();
  void write_line(const serial::Line& line);
  std::string file_progress() const;

  Gateway& gateway_;
  SerialFiles& files_;
  Options options_;
  serial::LineReader reader_;
  std::deque<serial::Line> lines_;
  std::string out_;
  std::size_t out_sent_ = 0;
  Counters counters_;
  LocalTime now_{0};

  ClientId client_ = 0;   ///< 0: no host is there
  bool mine_ = false;     ///< the gateway's lines were opened by this session
  bool homing_ = false;   ///< the G28 at the front found the machine without positions
  bool halted_ = false;   ///< after M112 nothing is taken until M999
  bool dropped_ = false;  ///< others ended this session's motion: no line moves until M110 or G28
  bool held_told_ = false;
  std::uint32_t count_ = 0;  ///< lines given to the gateway
  Wait wait_ = Wait::kNone;
  bool heats_ = false;  ///< the line at the front waits for a heater: temperatures are told meanwhile
  HeaterId waits_for_;
  bool waits_cooling_ = false;
  LocalTime last_line_{0}, last_command_{0}, next_busy_{0};

  LocalTime temperature_period_{0}, next_temperature_{0};  ///< M155
  LocalTime progress_period_{0}, next_progress_{0};        ///< M27 S
  std::string selected_;                                   ///< M23
  std::uint64_t selected_bytes_ = 0;
  SerialFiles::Asked asked_;  ///< by the line at the front
  bool starts_ = false;       ///< M32: the file is selected, its start is asked for
  bool file_runs_ = false;
  std::string writing_, written_;  ///< M28
};

}  // namespace kinebus
