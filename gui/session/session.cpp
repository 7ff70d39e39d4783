#include "gui/session/session.hpp"

#include <QByteArray>
#include <QRandomGenerator>
#include <QSysInfo>
#include <chrono>

#include "gui/link/link.hpp"
#include "gui/session/gateway_words.hpp"
#include "gui/session/job_upload.hpp"

namespace kinebus::gui {
namespace {

constexpr int kOpenAgain_ms = 700;
constexpr std::uint32_t kEventsKept = 500;

std::unique_ptr<joblink::Client> make_client() {
  joblink::Client::Options options;
  options.name = QStringLiteral("kinebus-gui (%1)").arg(QSysInfo::machineHostName()).toStdString();
  options.version = KINEBUS_VERSION;
  options.status_hz = 25;
  options.session_seed = QRandomGenerator::global()->generate();
  return std::make_unique<joblink::Client>(options);
}

}  // namespace

QString to_words(const joblink::Problem& problem) {
  return GatewayWords::said(problem);
}

Session::Session(QObject* parent) : QObject(parent), client_(make_client()), timer_(this), again_(this) {
  clock_.start();
  timer_.setSingleShot(true);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, [this] {
    client_->on_time(now());
    pump();
  });
  again_.setSingleShot(true);
  again_.setInterval(kOpenAgain_ms);
  connect(&again_, &QTimer::timeout, this, &Session::open_link);
}

Session::~Session() {
  // Nothing of a link that ends is news any more.
  if (link_ != nullptr) link_->disconnect(this);
}

kinebus::LocalTime Session::now() const {
  return kinebus::LocalTime(clock_.nsecsElapsed());
}

void Session::connect_to(LinkMaker maker, const Phrase& title) {
  disconnect_from_gateway();
  client_ = make_client();
  maker_ = std::move(maker);
  title_ = title;
  had_gateway_ = false;
  open_link();
}

void Session::disconnect_from_gateway() {
  again_.stop();
  maker_ = {};
  if (link_ != nullptr) {
    link_->disconnect(this);
    client_->on_disconnected(now(), "the user left");
    link_.release()->deleteLater();
  }
  pump();
  status_.Clear();
  machine_.Clear();
  jobs_.Clear();
  title_ = {};
  set_link_state(LinkState::kNone, {});
  emit status_changed();
  emit machine_changed();
  emit jobs_changed();
}

void Session::open_link() {
  if (!maker_) return;
  if (link_state_ != LinkState::kLost) set_link_state(LinkState::kConnecting, {});
  link_ = maker_();
  connect(link_.get(), &Link::opened, this, [this] {
    client_->on_connected(now());
    pump();
  });
  connect(link_.get(), &Link::closed, this, &Session::on_link_closed);
  connect(link_.get(), &Link::received, this, [this](const QByteArray& bytes) {
    client_->on_bytes(now(), {reinterpret_cast<const std::uint8_t*>(bytes.constData()),
                              static_cast<std::size_t>(bytes.size())});
    pump();
  });
  connect(link_.get(), &Link::drained, this, &Session::pump);
  link_->open();
}

void Session::on_link_closed(const Phrase& why) {
  if (link_ == nullptr) return;
  link_->disconnect(this);
  link_.release()->deleteLater();
  client_->on_disconnected(now(), why.said().toStdString());
  pump();
  set_link_state(had_gateway_ ? LinkState::kLost : LinkState::kConnecting, why);
  again_.start();
}

void Session::pump() {
  while (auto news = client_->next_news()) take(*news);
  while (link_ != nullptr) {
    const auto bytes = client_->next_bytes();
    if (bytes.empty()) break;
    const qint64 taken =
        link_->write(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()));
    if (taken <= 0) break;
    client_->on_bytes_sent(static_cast<std::size_t>(taken));
  }
  while (auto news = client_->next_news()) take(*news);
  arm();
}

void Session::arm() {
  const auto deadline = client_->next_deadline();
  if (deadline == kinebus::LocalTime::max()) {
    timer_.stop();
    return;
  }
  const auto wait = std::chrono::ceil<std::chrono::milliseconds>(deadline - now());
  timer_.start(std::max(std::chrono::milliseconds{0}, wait));
}

void Session::set_link_state(LinkState state, const Phrase& words) {
  if (state == link_state_ && words == link_words_) return;
  link_state_ = state;
  link_words_ = words;
  emit link_changed();
}

void Session::take(joblink::News& news) {
  if (auto* status = std::get_if<joblink::Status>(&news)) {
    status_.Swap(status);
    status_at_ns_ = clock_.nsecsElapsed();
    if (home_wanted_ && status_.state() != joblink::STATE_OFF && status_.state() != joblink::STATE_BRING_UP) {
      home_wanted_ = false;  // an alarm while waking ends the wish too
      if (status_.state() == joblink::STATE_UNHOMED || status_.state() == joblink::STATE_READY) home();
    }
    emit status_changed();
  } else if (auto* answer = std::get_if<joblink::Answer>(&news)) {
    const auto found = open_.find(answer->request);
    if (found == open_.end()) return;
    const Open open = std::move(found->second);
    open_.erase(found);
    round_trip_ms_ = static_cast<double>(clock_.nsecsElapsed() - open.sent_ns) * 1e-6;
    if (open.then)
      open.then(answer->reply);
    else if (!answer->ok())
      emit refused(to_words(answer->reply.error()));
  } else if (const auto* event = std::get_if<joblink::Event>(&news)) {
    if (event->kind() == joblink::EVENT_JOBS) list_jobs();
    emit event_arrived(*event);
  } else if (const auto* upload = std::get_if<joblink::UploadNews>(&news)) {
    emit upload_news(*upload);
  } else if (std::holds_alternative<joblink::Connected>(news)) {
    on_connected();
  } else if (const auto* lost = std::get_if<joblink::Disconnected>(&news)) {
    set_link_state(LinkState::kLost, Phrase(QString::fromStdString(lost->why)));
  }
}

void Session::on_connected() {
  had_gateway_ = true;
  set_link_state(LinkState::kConnected, link_ != nullptr ? link_->description() : Phrase());
  joblink::ClientMessage machine;
  machine.mutable_get_machine();
  send(std::move(machine), [this](const joblink::Reply& reply) {
    if (!reply.has_machine()) return;
    machine_ = reply.machine();
    emit machine_changed();
  });
  joblink::ClientMessage events;
  events.mutable_get_events()->set_max_events(kEventsKept);
  send(std::move(events), [this](const joblink::Reply& reply) {
    if (reply.has_events()) emit event_history(reply.events());
  });
  joblink::ClientMessage heat;
  heat.mutable_get_heat_course();
  // A gateway that does not know it refuses: then the graph begins now.
  send(std::move(heat), [this](const joblink::Reply& reply) {
    if (reply.has_heat_course()) emit heat_course_told(reply.heat_course());
  });
  list_jobs();
}

void Session::send(joblink::ClientMessage request, AnswerHandler then) {
  const qint64 sent_ns = clock_.nsecsElapsed();
  const joblink::RequestId id = client_->send(std::move(request));
  open_.emplace(id, Open{std::move(then), sent_ns});
  pump();
}

bool Session::has_control() const {
  return connected() && status_.controller() != 0 && status_.controller() == client_->client_id();
}

bool Session::others_have_control() const {
  return connected() && status_.controller() != 0 && status_.controller() != client_->client_id();
}

const joblink::CommandStatus* Session::find(joblink::Command command) const {
  for (const joblink::CommandStatus& status : status_.commands())
    if (status.command() == command) return &status;
  return nullptr;
}

bool Session::allowed(joblink::Command command) const {
  const joblink::CommandStatus* status = find(command);
  return connected() && (status == nullptr || status->allowed());
}

QString Session::why_not(joblink::Command command) const {
  const joblink::CommandStatus* status = find(command);
  return status != nullptr ? GatewayWords::said(status->why_not(), {}) : QString();
}

void Session::command(joblink::ClientMessage request, AnswerHandler then) {
  if (status_.controller() == 0) take_control(false);
  send(std::move(request), std::move(then));
}

void Session::take_control(bool force) {
  joblink::ClientMessage request;
  request.mutable_take_control()->set_force(force);
  send(std::move(request));
}

namespace {
/// A request that is only a name.
template <typename Choose>
joblink::ClientMessage plain(Choose choose) {
  joblink::ClientMessage request;
  choose(request);
  return request;
}
}  // namespace

void Session::release_control() {
  send(plain([](auto& r) { r.mutable_release_control(); }));
}
void Session::start_job(const QString& name) {
  command(plain([&](auto& r) { r.mutable_start_job()->set_name(name.toStdString()); }));
}
void Session::hold() {
  command(plain([](auto& r) { r.mutable_hold(); }));
}
void Session::resume() {
  command(plain([](auto& r) { r.mutable_resume(); }));
}
void Session::cancel() {
  command(plain([](auto& r) { r.mutable_cancel(); }));
}
void Session::stop() {
  send(plain([](auto& r) { r.mutable_stop(); }));  // everyone may, without control
}
void Session::clear() {
  command(plain([](auto& r) { r.mutable_clear(); }));
}
void Session::bring_up() {
  command(plain([](auto& r) { r.mutable_bring_up(); }));
}
void Session::home() {
  if (status_.state() == joblink::STATE_OFF) {
    home_wanted_ = true;
    command(plain([](auto& r) { r.mutable_bring_up(); }), [this](const joblink::Reply& reply) {
      if (!reply.has_error()) return;
      home_wanted_ = false;
      emit refused(to_words(reply.error()));
    });
    return;
  }
  command(plain([](auto& r) { r.mutable_home(); }));
}
void Session::go_to_reference() {
  command(plain([](auto& r) { r.mutable_reference(); }));
}
void Session::motors_off() {
  command(plain([](auto& r) { r.mutable_motors_off(); }));
}
void Session::jog(const joblink::Pose& delta, double speed_per_s, bool held, AnswerHandler then) {
  command(plain([&](auto& r) {
            *r.mutable_jog()->mutable_delta() = delta;
            r.mutable_jog()->set_speed_per_s(speed_per_s);
            r.mutable_jog()->set_while_held(held);
          }),
          std::move(then));
}
void Session::set_motor_currents(int joint, double run_a, double hold_a) {
  command(plain([&](auto& r) {
    r.mutable_set_motor_currents()->set_joint(static_cast<std::uint32_t>(joint));
    r.mutable_set_motor_currents()->set_run_a(run_a);
    r.mutable_set_motor_currents()->set_hold_a(hold_a);
  }));
}
void Session::tune_motor(int joint) {
  command(plain([&](auto& r) { r.mutable_tune_motor()->set_joint(static_cast<std::uint32_t>(joint)); }));
}
void Session::jog_motor(int joint, double distance) {
  command(plain([&](auto& r) {
    r.mutable_jog_motor()->set_joint(static_cast<std::uint32_t>(joint));
    r.mutable_jog_motor()->set_distance(distance);
  }));
}
void Session::exclude_object(const std::string& name) {
  command(plain([&](auto& r) { r.mutable_exclude_object()->set_name(name); }));
}
void Session::set_override(double ratio) {
  command(plain([&](auto& r) { r.mutable_set_override()->set_ratio(ratio); }));
}
void Session::set_heater(joblink::HeaterKind kind, std::uint32_t index, double celsius) {
  command(plain([&](auto& r) {
    r.mutable_set_temperature()->set_kind(kind);
    r.mutable_set_temperature()->set_index(index);
    r.mutable_set_temperature()->set_celsius(celsius);
  }));
}
void Session::move_probe_pin(joblink::MoveProbePin::Order order) {
  command(plain([&](auto& r) { r.mutable_move_probe_pin()->set_order(order); }));
}
void Session::tune_heater(joblink::HeaterKind kind, std::uint32_t index, double celsius) {
  command(plain([&](auto& r) {
    r.mutable_tune_heater()->set_kind(kind);
    r.mutable_tune_heater()->set_index(index);
    r.mutable_tune_heater()->set_celsius(celsius);
  }));
}
void Session::step_aside() {
  command(plain([](auto& r) { r.mutable_step_aside(); }));
}
void Session::move_filament(joblink::MoveFilament::What what) {
  command(plain([&](auto& r) { r.mutable_move_filament()->set_what(what); }));
}
void Session::restart_gateway(AnswerHandler then) {
  command(plain([](auto& r) { r.mutable_restart_gateway(); }), std::move(then));
}
void Session::set_fan(double ratio) {
  command(plain([&](auto& r) { r.mutable_set_fan()->set_ratio(ratio); }));
}
void Session::set_work_offset(std::uint32_t system, const joblink::Pose& offset, bool here) {
  command(plain([&](auto& r) {
    auto& set = *r.mutable_set_work_offset();
    set.set_system(system);
    *set.mutable_offset() = offset;
    set.set_here(here);
  }));
}
void Session::console(const QString& line, AnswerHandler then) {
  command(plain([&](auto& r) { r.mutable_console()->set_line(line.toStdString()); }), std::move(then));
}

void Session::list_jobs() {
  list_jobs_after({});
}
/// A long list comes in parts; views see it when it is whole.
void Session::list_jobs_after(joblink::JobList so_far) {
  const std::string last =
      so_far.jobs_size() > 0 ? so_far.jobs(so_far.jobs_size() - 1).name() : std::string();
  send(plain([&](auto& r) { r.mutable_list_jobs()->set_after_name(last); }),
       [this, so_far = std::move(so_far)](const joblink::Reply& reply) mutable {
         if (!reply.has_jobs()) return;
         so_far.MergeFrom(reply.jobs());
         if (reply.jobs().more() && reply.jobs().jobs_size() > 0) return list_jobs_after(std::move(so_far));
         jobs_ = std::move(so_far);
         emit jobs_changed();
       });
}
void Session::delete_job(const QString& name) {
  send(plain([&](auto& r) { r.mutable_delete_job()->set_name(name.toStdString()); }),
       [this](const joblink::Reply& reply) {
         if (reply.has_error()) emit refused(to_words(reply.error()));
         list_jobs();
       });
}
void Session::check_job(const QString& name, AnswerHandler then) {
  send(plain([&](auto& r) { r.mutable_check_job()->set_name(name.toStdString()); }), std::move(then));
}

JobUpload* Session::upload(const QString& file_path) {
  auto* upload = new JobUpload(*this, file_path);
  emit upload_begun(upload);
  upload->begin();
  return upload;
}

}  // namespace kinebus::gui
