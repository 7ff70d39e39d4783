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
  doing_->setWordWrap(true);
  // Buttons below stay where they are, whether there is something to say or not.
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
  const auto fact = [&](int row, QLabel*& value, auto words) {
    auto* name = make_label("muted", card);
    value = new QLabel(card);
    value->setAlignment(Qt::AlignTrailing);
    facts->addWidget(name, row / 2, row % 2 * 2);
    facts->addWidget(value, row / 2, row % 2 * 2 + 1);
    says([name, words] { name->setText(words()); });
  };
  fact(1, percent_, [] { return tr("Progress"); });
  fact(0, elapsed_, [] { return tr("Elapsed"); });
  fact(2, remaining_, [] { return tr("Remaining"); });
  fact(3, line_, [] { return tr("Line"); });
  card->column()->addLayout(facts);

  auto* speed = new QHBoxLayout;
  auto* speed_name = make_label("muted", card);
  override_ = new QSlider(Qt::Horizontal, card);
  override_->setRange(10, 200);
  override_->setPageStep(10);
  override_->setValue(100);
  turn_with_focus_only(*override_);
  override_text_ = new QLabel(card);
  override_text_->setMinimumWidth(override_text_->fontMetrics().horizontalAdvance(QStringLiteral("%500")) +
                                  6);
  override_text_->setAlignment(Qt::AlignTrailing);
  speed->addWidget(speed_name);
  speed->addWidget(override_, 1);
  speed->addWidget(override_text_);
  card->column()->addLayout(speed);
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
  buttons->addWidget(pause_, 1);
  buttons->addWidget(resume_, 1);
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
  objects_ = make_button(desk_.theme, QStringLiteral("cancel"), "", card);
  card->column()->addWidget(objects_);
  connect(objects_, &QPushButton::clicked, this, &JobPanel::choose_object);
  connect(&desk_.session, &Session::status_changed, this, &JobPanel::take_status);
  connect(&desk_.session, &Session::link_changed, this, &JobPanel::take_status);
  says([this, speed_name] {
    speed_name->setText(tr("Speed"));
    override_->setAccessibleName(tr("Feed override in percent"));
    speak_direction(*override_);
    pause_->setText(tr("Pause"));
    resume_->setText(tr("Resume"));
    cancel_->setText(tr("Cancel"));
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

void JobPanel::take_status() {
  const joblink::Status& s = desk_.session.status();
  const bool connected = desk_.session.connected();
  // What was known when the link broke stays on the screen and is called so.
  const bool lost = desk_.session.link_state() == Session::LinkState::kLost;
  const bool job = (connected || lost) && !s.job().empty();
  name_->set_text(job ? QString::fromStdString(s.job()) : tr("No job is running"));
  const bool interrupted = job && s.interrupted() && s.state() != joblink::STATE_HELD;
  // What a job waits for, while nothing moves, is the gateway's to say.
  const bool busy = job && (s.state() == joblink::STATE_RUNNING || s.state() == joblink::STATE_CHECKING);
  doing_->setText(lost && job   ? tr("Last known: what the job does now is not.")
                  : interrupted ? tr("Interrupted: resume goes on from its place.")
                  : busy        ? GatewayWords::said(s.doing_said(), s.doing())
                                : QString());
  for (QWidget* known :
       {static_cast<QWidget*>(progress_), static_cast<QWidget*>(percent_), static_cast<QWidget*>(elapsed_),
        static_cast<QWidget*>(remaining_), static_cast<QWidget*>(line_)})
    known->setEnabled(!lost);
  progress_->setValue(job ? static_cast<int>(std::lround(s.progress() * 1000)) : 0);
  const QString none = QStringLiteral("—");
  percent_->setText(job ? Format::percent(s.progress(), 1) : none);
  elapsed_->setText(job ? Format::duration(s.elapsed_s()) : none);
  remaining_->setText(job ? Format::duration(s.remaining_s()) : none);
  line_->setText(job && s.line() > 0 ? Format::number(s.line(), 0) : none);
  if (!override_->isSliderDown() && connected && s.feed_override() > 0) {
    const QSignalBlocker quiet(override_);
    override_->setValue(static_cast<int>(std::lround(s.feed_override() * 100)));
    // Another client may have set more than the slider can.
    override_text_->setText(Format::percent(s.feed_override()));
  }
  const bool resume = desk_.session.allowed(joblink::COMMAND_RESUME);
  pause_->setVisible(!resume);
  set_usable(*pause_, desk_.session.allowed(joblink::COMMAND_HOLD),
             desk_.session.why_not(joblink::COMMAND_HOLD));
  resume_->setVisible(resume);
  set_usable(*cancel_, desk_.session.allowed(joblink::COMMAND_CANCEL),
             desk_.session.why_not(joblink::COMMAND_CANCEL));
  override_->setEnabled(connected);
  objects_->setVisible(s.objects_size() > 0);
  set_usable(*objects_, desk_.session.allowed(joblink::COMMAND_EXCLUDE_OBJECT),
             desk_.session.why_not(joblink::COMMAND_EXCLUDE_OBJECT));
}

}  // namespace kinebus::gui
