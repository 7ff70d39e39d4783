#include "gui/views/job_panel.hpp"

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSizePolicy>
#include <QStackedLayout>
#include <QTimer>
#include <QVBoxLayout>
#include <QWidget>
#include <cmath>

#include "gui/models/format.hpp"
#include "gui/session/gateway_words.hpp"

namespace kinebus::gui {

JobPanel::JobPanel(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(6, 0, 12, 2);
  auto* card = new Card(this);
  card->column()->setContentsMargins(14, 9, 14, 10);
  card->column()->setSpacing(5);
  outer->addWidget(card);
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);  // the rest of the side is the position's

  name_ = new ElidedLabel(card);
  name_->setProperty("role", "heading");
  doing_ = make_label("small", card);
  wrap_words(*doing_);
  // Buttons below stay where they are, whether there is something to say or not: in the font that is shown.
  doing_->ensurePolished();
  doing_->setMinimumHeight(2 * doing_->fontMetrics().lineSpacing());
  doing_->setAlignment(Qt::AlignTop | Qt::AlignLeading);
  progress_ = new QProgressBar(card);
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  card->column()->addWidget(name_);
  card->column()->addWidget(doing_);
  card->column()->addWidget(progress_);

  auto* facts = new QGridLayout;
  facts->setVerticalSpacing(2);
  facts->setHorizontalSpacing(8);
  facts->setColumnStretch(1, 1);
  facts->setColumnStretch(3, 1);
  for (std::size_t i = 0; i < facts_.size(); ++i) {
    const int row = static_cast<int>(i) / 2, column = static_cast<int>(i) % 2 * 2;
    facts_[i] = {make_label("muted", card), new QLabel(card)};
    facts->addWidget(facts_[i].name, row, column);
    facts->addWidget(facts_[i].value, row, column + 1);
  }
  card->column()->addLayout(facts);

  speed_row_ = new QWidget(card);
  auto* speed = new QHBoxLayout(speed_row_);
  speed->setContentsMargins(0, 0, 0, 0);
  auto* speed_name = make_label("muted", card);
  override_ = new QSlider(Qt::Horizontal, card);
  override_->setRange(10, 200);
  override_->setPageStep(10);
  override_->setValue(100);
  turn_with_focus_only(*override_);
  override_text_ = new QLabel(card);
  override_text_->setMinimumWidth(override_text_->fontMetrics().horizontalAdvance(QStringLiteral("%500")) +
                                  6);
  speed->addWidget(speed_name);
  speed->addWidget(override_, 1);
  speed->addWidget(override_text_);
  card->column()->addWidget(speed_row_);
  connect(override_, &QSlider::valueChanged, this,
          [this](int percent) { override_text_->setText(Format::percent(percent / 100.0)); });
  const auto send = [this] {
    if (desk_.session.connected()) desk_.session.set_override(override_->value() / 100.0);
  };
  connect(override_, &QSlider::sliderReleased, this, send);
  connect(override_, &QSlider::actionTriggered, this, [this, send](int action) {
    if (action != QAbstractSlider::SliderMove) QTimer::singleShot(0, this, send);
  });

  pause_ = make_button(desk_.theme, QStringLiteral("pause"), "primary", card);
  resume_ = make_button(desk_.theme, QStringLiteral("play"), "primary", card);
  cancel_ = make_button(desk_.theme, QStringLiteral("cancel"), "danger", card);
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(8);
  // One takes the other's place, and nothing beside it moves.
  auto* slot = new QWidget(card);
  pause_or_resume_ = new QStackedLayout(slot);
  pause_or_resume_->addWidget(pause_);
  pause_or_resume_->addWidget(resume_);
  buttons->addWidget(slot, 1);
  buttons->addWidget(cancel_, 1);
  card->column()->addSpacing(2);
  card->column()->addLayout(buttons);
  connect(pause_, &QPushButton::clicked, &desk_.session, &Session::hold);
  connect(resume_, &QPushButton::clicked, &desk_.session, &Session::resume);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    auto* question = new QMessageBox(QMessageBox::Question, tr("Cancel the job"),
                                     tr("Cancel the job? What is printed stays on the bed."),
                                     QMessageBox::NoButton, window());
    question->setAttribute(Qt::WA_DeleteOnClose);
    auto* yes = question->addButton(tr("Cancel the job"), QMessageBox::DestructiveRole);
    auto* no = question->addButton(tr("Go on"), QMessageBox::RejectRole);
    question->setDefaultButton(no);
    question->setEscapeButton(no);
    connect(yes, &QAbstractButton::clicked, &desk_.session, &Session::cancel);
    question->open();
  });
  aside_ = make_button(desk_.theme, QStringLiteral("up"), "", card);
  connect(aside_, &QPushButton::clicked, &desk_.session, &Session::step_aside);
  filament_ = new FilamentKeys(desk_, card);
  // The row is always there: nothing above it moves when a job is held.
  auto* row = new QWidget(card);
  aside_or_filament_ = new QStackedLayout(row);
  aside_or_filament_->addWidget(aside_);
  aside_or_filament_->addWidget(filament_);
  card->column()->addWidget(row);
  objects_ = make_button(desk_.theme, QStringLiteral("cancel"), "", card);
  card->column()->addWidget(objects_);
  connect(objects_, &QPushButton::clicked, this, &JobPanel::choose_object);
  connect(&desk_.session, &Session::status_changed, this, &JobPanel::take_status);
  connect(&desk_.session, &Session::link_changed, this, &JobPanel::take_status);
  connect(&desk_.record, &JobRecord::ended, this, &JobPanel::take_status);
  says([this, speed_name] {
    speed_name->setText(tr("Speed"));
    progress_->setAccessibleName(tr("Progress"));
    override_->setAccessibleName(tr("Feed override in percent"));
    speak_direction(*override_);
    for (const auto& fact : facts_) align_trailing(*fact.value);
    align_trailing(*override_text_);
    pause_->setText(tr("Pause"));
    resume_->setText(tr("Resume"));
    cancel_->setText(tr("Cancel"));
    aside_->setText(tr("Set aside"));
    aside_->setToolTip(
        tr("The tool rises and parks: then jog, heat, extrude or change the filament. Resume goes "
           "on from the job's place."));
    objects_->setText(tr("Leave an object out"));
    override_text_->setText(Format::percent(override_->value() / 100.0));
    take_status();
  });
}

/// Which one; and whether it is meant, for it cannot be taken back.
void JobPanel::choose_object() {
  auto* menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  for (const joblink::PrintObject& object : desk_.session.status().objects()) {
    QString shown = QString::fromStdString(object.name());
    QAction* const one = menu->addAction(shown.replace(QLatin1Char('&'), QStringLiteral("&&")));
    one->setEnabled(!object.left_out());
    connect(one, &QAction::triggered, this, [this, name = object.name()] {
      auto* question = new QMessageBox(
          QMessageBox::Question, tr("Leave an object out"),
          tr("Print no more of %1? It cannot be taken back.").arg(QString::fromStdString(name)),
          QMessageBox::NoButton, window());
      question->setAttribute(Qt::WA_DeleteOnClose);
      auto* yes = question->addButton(tr("Leave an object out"), QMessageBox::DestructiveRole);
      auto* no = question->addButton(tr("Go on"), QMessageBox::RejectRole);
      question->setDefaultButton(no);
      question->setEscapeButton(no);
      connect(yes, &QAbstractButton::clicked, &desk_.session,
              [this, name] { desk_.session.exclude_object(name); });
      question->open();
    });
  }
  menu->popup(objects_->mapToGlobal(QPoint(0, objects_->height())));
}

QString JobPanel::doing(bool job, bool report, bool lost) const {
  const joblink::Status& s = desk_.session.status();
  if (lost && job) return tr("Last known. What the job does now is unknown.");
  if (report) switch (desk_.record.end()) {
      case JobRecord::End::kComplete:
        return tr("Finished.");
      case JobRecord::End::kCancelled:
        return tr("Cancelled.");
      case JobRecord::End::kRefused:
        return tr("Not begun: the Jobs page says what is wrong.");
      default:
        return tr("Ended by a stop.");
    }
  const bool interrupted = job && s.interrupted() && s.state() != joblink::STATE_HELD;
  if (interrupted && s.state() == joblink::STATE_READY && s.filament_change())
    return tr("Change the filament: load, purge, then resume.");
  // Why it was held, and until when it does not go on.
  if (job && (interrupted || s.state() == joblink::STATE_HELD))
    for (const joblink::FilamentSensor& sensor : s.filament_sensors())
      if (sensor.has_words()) return GatewayWords::said(sensor.words(), {});
  if (interrupted && s.state() == joblink::STATE_STOPPED)
    return tr("Interrupted: clear the stop, then resume goes on from its place.");
  if (interrupted && s.state() == joblink::STATE_ALARM)
    return tr("Interrupted: clear the alarm, then resume goes on from its place.");
  if (interrupted) return tr("Interrupted: resume goes on from its place.");
  // What a job waits for, while nothing moves, is the gateway's to say.
  const bool busy = job && (s.state() == joblink::STATE_RUNNING || s.state() == joblink::STATE_CHECKING);
  return busy ? GatewayWords::said(s.doing_said(), s.doing()) : QString();
}

std::array<JobPanel::Fact, 6> JobPanel::facts(bool job, bool report) const {
  const joblink::Status& s = desk_.session.status();
  const QString none = QStringLiteral("—");
  if (!report)
    return {{{tr("Elapsed"), job ? Format::duration(s.elapsed_s()) : none},
             {tr("Progress"), job ? Format::percent(s.progress(), 1) : none},
             {tr("Remaining"), job ? Format::duration(s.remaining_s()) : none},
             {tr("Line"), job && s.line() > 0 ? Format::number(s.line(), 0) : none},
             {},
             {}}};
  const JobRecord::Figures& f = desk_.record.figures();
  // Three digits say enough, and fit.
  const int filament_decimals = f.filament_mm < 10e3 ? 2 : f.filament_mm < 100e3 ? 1 : 0;
  return {{{tr("Elapsed"), Format::duration(f.elapsed_s)},
           {tr("Filament"),
            Format::isolated(tr("%1 m").arg(Format::number(f.filament_mm * 1e-3, filament_decimals)))},
           {tr("Clock error"), Format::isolated(tr("%1 µs").arg(Format::number(f.clock_error_us, 1)))},
           {tr("Bus load"), Format::percent(f.bus_load, 0)},
           {tr("Least queue"), f.emptiest_queue < 1 ? Format::percent(f.emptiest_queue, 0) : none},
           {tr("Slowed"), Format::number(f.stalls, 0)}}};
}

void JobPanel::take_status() {
  const joblink::Status& s = desk_.session.status();
  const bool connected = desk_.session.connected();
  // What was known when the link broke stays on the screen and is called so.
  const bool lost = desk_.session.link_state() == Session::LinkState::kLost;
  const bool job = (connected || lost) && !s.job().empty();
  const bool report = (connected || lost) && !job && desk_.record.end() != JobRecord::End::kNone;
  name_->set_text(job      ? QString::fromStdString(s.job())
                  : report ? QString::fromStdString(desk_.record.name())
                           : tr("No job is running"));
  const QString words = doing(job, report, lost);
  if (doing_->text() != words) doing_->setText(words);
  const auto all = facts(job, report);
  for (std::size_t i = 0; i < all.size(); ++i) {
    facts_[i].name->setVisible(!all[i].name.isEmpty());
    facts_[i].value->setVisible(!all[i].name.isEmpty());
    if (facts_[i].name->text() != all[i].name) facts_[i].name->setText(all[i].name);
    if (facts_[i].value->text() != all[i].value) facts_[i].value->setText(all[i].value);
    facts_[i].value->setEnabled(!lost);
  }
  // The report's last line is where the speed was.
  speed_row_->setVisible(!report);
  progress_->setEnabled(!lost);
  const bool whole = report && desk_.record.end() == JobRecord::End::kComplete;
  progress_->setValue(job ? static_cast<int>(std::lround(s.progress() * 1000)) : whole ? 1000 : 0);
  if (!override_->isSliderDown() && connected && s.feed_override() > 0) {
    const QSignalBlocker quiet(override_);
    override_->setValue(static_cast<int>(std::lround(s.feed_override() * 100)));
    // Another client may have set more than the slider can.
    override_text_->setText(Format::percent(s.feed_override()));
  }
  // What is interrupted has nothing to pause: resume stands there also while a stop is not cleared.
  const bool resume = desk_.session.allowed(joblink::COMMAND_RESUME) || (connected && job && s.interrupted());
  pause_or_resume_->setCurrentWidget(resume ? resume_ : pause_);
  set_usable(*resume_, desk_.session.allowed(joblink::COMMAND_RESUME),
             desk_.session.why_not(joblink::COMMAND_RESUME));
  set_usable(*pause_, desk_.session.allowed(joblink::COMMAND_HOLD),
             desk_.session.why_not(joblink::COMMAND_HOLD));
  set_usable(*cancel_, desk_.session.allowed(joblink::COMMAND_CANCEL),
             desk_.session.why_not(joblink::COMMAND_CANCEL));
  override_->setEnabled(connected);
  set_usable(*aside_, job && desk_.session.allowed(joblink::COMMAND_STEP_ASIDE),
             desk_.session.why_not(joblink::COMMAND_STEP_ASIDE));
  const bool is_aside = connected && job && s.interrupted() && s.state() != joblink::STATE_HELD;
  aside_or_filament_->setCurrentWidget(is_aside && filament_->is_of_use() ? static_cast<QWidget*>(filament_)
                                                                          : aside_);
  objects_->setVisible(s.objects_size() > 0);
  set_usable(*objects_, desk_.session.allowed(joblink::COMMAND_EXCLUDE_OBJECT),
             desk_.session.why_not(joblink::COMMAND_EXCLUDE_OBJECT));
}

}  // namespace kinebus::gui
