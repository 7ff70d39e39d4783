#pragma once
// The conversation with one gateway: commands as methods, news as signals. A link that breaks is opened again
// by itself; the job link's client resumes where it was.

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <functional>
#include <memory>
#include <unordered_map>

#include "gui/link/phrase.hpp"
#include "protocol/joblink/client.hpp"

namespace kinebus::gui {

class Link;
class JobUpload;

class Session : public QObject {
  Q_OBJECT
 public:
  enum class LinkState { kNone, kConnecting, kConnected, kLost };
  Q_ENUM(LinkState)
  using LinkMaker = std::function<std::unique_ptr<Link>()>;
  using AnswerHandler = std::function<void(const joblink::Reply&)>;

  explicit Session(QObject* parent = nullptr);
  ~Session() override;

  /// Leaves the gateway before and turns to another. `title`: what the user calls it.
  void connect_to(LinkMaker maker, const Phrase& title);
  void disconnect_from_gateway();

  LinkState link_state() const { return link_state_; }
  /// Read in the direction of its own first letter: it may be a path, in a language from right to left, too.
  QString gateway_title() const { return QChar(0x2068) + title_.said() + QChar(0x2069); }
  QString link_words() const { return link_words_.said(); }  ///< why it is lost, or how it is connected
  /// How long ago the newest status came: while the link is lost, status() is what was known then.
  double status_age_s() const { return static_cast<double>(clock_.nsecsElapsed() - status_at_ns_) * 1e-9; }
  const joblink::HelloReply& hello() const { return client_->hello(); }
  const joblink::Status& status() const { return status_; }
  const joblink::MachineInfo& machine() const { return machine_; }
  const joblink::JobList& jobs() const { return jobs_; }
  bool connected() const { return link_state_ == LinkState::kConnected; }
  bool has_control() const;
  bool others_have_control() const;
  double round_trip_ms() const { return round_trip_ms_; }  ///< of the newest answer
  /// Whether the machine takes the command now, as the gateway says; one that does not say refuses by itself.
  bool allowed(joblink::Command command) const;
  /// What the gateway says why not, in the user's language; empty: it is allowed.
  QString why_not(joblink::Command command) const;

  /// Sends what `request` holds; the answer comes to `then`, also when it is a refusal. Refusals nobody
  /// handles are told by refused().
  void send(joblink::ClientMessage request, AnswerHandler then = {});
  /// As send(), for what needs control: takes it first when nobody has it.
  void command(joblink::ClientMessage request, AnswerHandler then = {});

  // The machine.
  void start_job(const QString& name);
  void hold();
  void resume();
  void cancel();
  void stop();
  void clear();
  void bring_up();
  /// Wakes the nodes first when the machine is off.
  void home();
  void go_to_reference();
  void motors_off();
  /// `held`: as long as this is asked for again (joblink::Jog).
  void jog(const joblink::Pose& delta, double speed_per_s, bool held = false, AnswerHandler then = {});
  /// Of the joint at this place of the machine's list, A.
  void set_motor_currents(int joint, double run_a, double hold_a);
  void tune_motor(int joint);
  /// One joint alone, mm or rad.
  void jog_motor(int joint, double distance);
  void set_override(double ratio);
  /// 0 switches it off, and ends its measurement.
  void set_heater(joblink::HeaterKind kind, std::uint32_t index, double celsius);
  /// Of the print under way; it cannot be taken back.
  void exclude_object(const std::string& name);
  void move_probe_pin(joblink::MoveProbePin::Order order);
  /// Its node measures it, to be good at `celsius`.
  void tune_heater(joblink::HeaterKind kind, std::uint32_t index, double celsius);
  /// The job that is held, so that the machine may be moved meanwhile.
  void step_aside();
  void move_filament(joblink::MoveFilament::What what);
  void restart_gateway(AnswerHandler then);
  void set_fan(double ratio);
  void set_work_offset(std::uint32_t system, const joblink::Pose& offset, bool here);
  void console(const QString& line, AnswerHandler then);
  void take_control(bool force);
  void release_control();

  // Jobs.
  void list_jobs();
  void delete_job(const QString& name);
  void check_job(const QString& name, AnswerHandler then);
  /// Reads, hashes and sends a file; its object tells how it goes and belongs to the session.
  JobUpload* upload(const QString& file_path);
  joblink::Client& client() { return *client_; }
  /// Sends what the client has to say. After client() was used directly.
  void pump();

 signals:
  void link_changed();
  void status_changed();
  void machine_changed();
  void jobs_changed();
  void event_arrived(const kinebus::joblink::Event& event);
  void event_history(const kinebus::joblink::EventList& events);
  /// What was before this client came.
  void heat_course_told(const kinebus::joblink::HeatCourse& course);
  void upload_news(const kinebus::joblink::UploadNews& news);
  void upload_begun(kinebus::gui::JobUpload* upload);
  /// A command was not carried out; `words` is for the user.
  void refused(const QString& words);

 private:
  void list_jobs_after(joblink::JobList so_far);
  void open_link();
  void on_link_closed(const Phrase& why);
  void on_connected();
  void take(joblink::News& news);
  void set_link_state(LinkState state, const Phrase& words);
  const joblink::CommandStatus* find(joblink::Command command) const;
  kinebus::LocalTime now() const;
  void arm();

  std::unique_ptr<joblink::Client> client_;
  std::unique_ptr<Link> link_;
  LinkMaker maker_;
  Phrase title_, link_words_;
  LinkState link_state_ = LinkState::kNone;
  bool had_gateway_ = false;
  bool home_wanted_ = false;  ///< as soon as the nodes are awake
  QElapsedTimer clock_;
  QTimer timer_, again_;
  struct Open {
    AnswerHandler then;
    qint64 sent_ns = 0;
  };
  std::unordered_map<joblink::RequestId, Open> open_;
  joblink::Status status_;
  qint64 status_at_ns_ = 0;
  joblink::MachineInfo machine_;
  joblink::JobList jobs_;
  double round_trip_ms_ = 0;
};

/// A problem in one line: place, rule, expectation.
QString to_words(const joblink::Problem& problem);

}  // namespace kinebus::gui
