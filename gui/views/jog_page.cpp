#include "gui/views/jog_page.hpp"

#include <QAbstractButton>
#include <QChar>
#include <QEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLatin1Char>
#include <QLocale>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>
#include <array>
#include <numbers>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {
constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr std::array<double, 5> kSteps{0.01, 0.1, 1, 10, 50};
constexpr std::array<const char*, 9> kSystems{"G54", "G55",   "G56",   "G57",  "G58",
                                              "G59", "G59.1", "G59.2", "G59.3"};
}  // namespace

JogPage::JogPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  setFocusPolicy(Qt::StrongFocus);
  auto* body = new QWidget;
  auto* grid = new QGridLayout(body);
  grid->setContentsMargins(14, 12, 14, 12);
  grid->setSpacing(12);
  grid->addWidget(make_pad(), 0, 0, 2, 1);
  grid->addWidget(make_actions(), 0, 1);
  grid->addWidget(make_offsets(), 1, 1);
  grid->setColumnStretch(0, 3);
  grid->setColumnStretch(1, 2);
  grid->setRowStretch(1, 1);
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(body);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(scroll);
  connect(&desk_.session, &Session::status_changed, this, &JogPage::take_status);
  connect(&desk_.session, &Session::link_changed, this, &JogPage::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &JogPage::take_machine);
  for (QAbstractButton* button : findChildren<QAbstractButton*>()) {
    button->installEventFilter(this);
    button->setFocusPolicy(Qt::TabFocus);  // the page keeps the keys when a button is clicked
  }
  take_machine();
  take_status();
}

/// A button that has the focus would take arrows for a way to the next button: they jog.
bool JogPage::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress) return SpeakingWidget::eventFilter(watched, event);
  auto* press = static_cast<QKeyEvent*>(event);
  const bool arrow = press->key() == Qt::Key_Left || press->key() == Qt::Key_Right ||
                     press->key() == Qt::Key_Up || press->key() == Qt::Key_Down;
  if (!arrow || press->modifiers() != Qt::NoModifier) return SpeakingWidget::eventFilter(watched, event);
  keyPressEvent(press);
  return true;
}

QPushButton* JogPage::jog_button(Axis axis, int sign, const QString& icon) {
  auto* button = make_button(desk_.theme, icon, "jog", this);
  static constexpr std::array<const char*, 6> kNames{"X", "Y", "Z", "A", "C", "E"};
  const QString name = QString::fromLatin1(kNames[static_cast<std::size_t>(axis)]) +
                       (sign > 0 ? QLatin1Char('+') : QChar(0x2212));
  button->setText(Format::isolated(name));
  button->setLayoutDirection(Qt::LeftToRight);
  button->setAccessibleName(name);
  connect(button, &QPushButton::clicked, this, [this, axis, sign] { jog(axis, sign); });
  jog_buttons_.push_back(button);
  if (axis == Axis::kA || axis == Axis::kC) turn_buttons_.push_back(button);
  return button;
}

QWidget* JogPage::make_pad() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  // Left is left on the machine, whatever the language.
  auto* pad = new QWidget(card);
  pad->setLayoutDirection(Qt::LeftToRight);
  auto* grid = new QGridLayout(pad);
  grid->setContentsMargins(0, 6, 0, 6);
  grid->setSpacing(6);
  const auto key = [](const char* name) { return QString::fromLatin1(name); };
  grid->addWidget(jog_button(Axis::kY, 1, key("up")), 0, 1);
  grid->addWidget(jog_button(Axis::kX, -1, key("left")), 1, 0);
  grid->addWidget(jog_button(Axis::kX, 1, key("right")), 1, 2);
  grid->addWidget(jog_button(Axis::kY, -1, key("down")), 2, 1);
  grid->addWidget(jog_button(Axis::kZ, 1, key("up")), 0, 4);
  grid->addWidget(jog_button(Axis::kZ, -1, key("down")), 2, 4);
  grid->addWidget(jog_button(Axis::kA, 1, key("turn-left")), 0, 6);
  grid->addWidget(jog_button(Axis::kA, -1, key("turn-right")), 2, 6);
  grid->addWidget(jog_button(Axis::kC, 1, key("turn-left")), 0, 7);
  grid->addWidget(jog_button(Axis::kC, -1, key("turn-right")), 2, 7);
  grid->addWidget(jog_button(Axis::kE, 1, key("up")), 0, 9);
  grid->addWidget(jog_button(Axis::kE, -1, key("down")), 2, 9);
  auto* centre = new QLabel(QStringLiteral("XY"), pad);
  centre->setProperty("role", "muted");
  centre->setAlignment(Qt::AlignCenter);
  grid->addWidget(centre, 1, 1);
  const auto label = [&](const QString& text, int column, int span = 1) {
    auto* name = new QLabel(text, pad);
    name->setProperty("role", "muted");
    name->setAlignment(Qt::AlignCenter);
    grid->addWidget(name, 1, column, 1, span);
  };
  label(QStringLiteral("Z"), 4);
  label(QStringLiteral("A"), 6);
  label(QStringLiteral("C"), 7);
  label(QStringLiteral("E"), 9);
  for (const int gap : {3, 5, 8}) grid->setColumnMinimumWidth(gap, 8);
  auto* centred = new QHBoxLayout;
  centred->addStretch(1);
  centred->addWidget(pad);
  centred->addStretch(1);
  card->column()->addLayout(centred);
  card->column()->addWidget(make_steps());
  hint_ = make_label("small", card);
  hint_->setWordWrap(true);
  card->column()->addWidget(hint_);
  card->column()->addStretch(1);
  says([this, heading] {
    heading->setText(tr("Jog"));
    hint_->setText(
        tr("Keys: arrows move X and Y, Page Up and Page Down move Z, A and D tilt, Q and W turn the table, "
           "1 to 5 choose the step."));
  });
  return card;
}

QWidget* JogPage::make_steps() {
  auto* box = new QWidget(this);
  auto* grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(12);
  grid->setVerticalSpacing(8);
  auto* step_name = make_label("muted", box);
  auto* row = new QHBoxLayout;
  row->setSpacing(6);
  steps_ = new QButtonGroup(box);
  QVector<QPushButton*> buttons;
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    auto* button = make_button(desk_.theme, {}, "step", box);
    button->setCheckable(true);
    steps_->addButton(button, static_cast<int>(i));
    row->addWidget(button);
    buttons.push_back(button);
  }
  row->addStretch(1);
  steps_->button(2)->setChecked(true);
  auto* speed_name = make_label("muted", box);
  speed_ = new NumberField(box);
  speed_->setRange(1, 300);
  speed_->setDecimals(0);
  speed_->setValue(50);
  speed_->setFixedWidth(110);
  grid->addWidget(step_name, 0, 0);
  grid->addLayout(row, 0, 1);
  grid->addWidget(speed_name, 1, 0);
  grid->addWidget(speed_, 1, 1, Qt::AlignLeading);
  grid->setColumnStretch(1, 1);
  says([this, step_name, speed_name, buttons] {
    step_name->setText(tr("Step, mm or °"));
    speed_name->setText(tr("Speed"));
    speed_->setSuffix(QStringLiteral(" ") + tr("mm/s"));
    for (std::size_t i = 0; i < kSteps.size(); ++i)
      buttons[static_cast<int>(i)]->setText(QLocale().toString(kSteps[i], 'g', 4));
  });
  return box;
}

QWidget* JogPage::make_actions() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  home_ = make_button(desk_.theme, QStringLiteral("home"), "primary", card);
  reference_ = make_button(desk_.theme, QStringLiteral("reference"), "", card);
  hold_ = make_button(desk_.theme, QStringLiteral("pause"), "", card);
  clear_ = make_button(desk_.theme, QStringLiteral("clear"), "", card);
  motors_off_ = make_button(desk_.theme, QStringLiteral("power"), "danger", card);
  auto* grid = new QGridLayout;
  grid->setSpacing(8);
  grid->addWidget(home_, 0, 0);
  grid->addWidget(reference_, 0, 1);
  grid->addWidget(hold_, 1, 0);
  grid->addWidget(clear_, 1, 1);
  grid->addWidget(motors_off_, 2, 0, 1, 2);
  card->column()->addLayout(grid);
  connect(home_, &QPushButton::clicked, &desk_.session, &Session::home);
  connect(reference_, &QPushButton::clicked, &desk_.session, &Session::go_to_reference);
  connect(hold_, &QPushButton::clicked, &desk_.session, &Session::hold);
  connect(clear_, &QPushButton::clicked, &desk_.session, &Session::clear);
  connect(motors_off_, &QPushButton::clicked, &desk_.session, &Session::motors_off);
  says([this, heading] {
    heading->setText(tr("Machine"));
    home_->setText(tr("Home"));
    home_->setToolTip(tr("Wakes the nodes and brings all carriages to their switches"));
    reference_->setText(tr("Bed reference"));
    reference_->setToolTip(tr("Goes to where every job begins"));
    hold_->setText(tr("Pause"));
    clear_->setText(tr("Clear stop"));
    motors_off_->setText(tr("Motors off"));
    motors_off_->setToolTip(tr("Positions are lost: the machine must be homed again"));
  });
  return card;
}

QWidget* JogPage::make_offsets() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  active_offset_ = make_label("small", card);
  active_offset_->setWordWrap(true);
  system_ = new QComboBox(card);
  for (const char* name : kSystems) system_->addItem(QString::fromLatin1(name));
  auto* top = new QHBoxLayout;
  top->addWidget(heading);
  top->addStretch(1);
  top->addWidget(system_);
  card->column()->addLayout(top);
  card->column()->addWidget(active_offset_);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(6);
  static constexpr std::array<const char*, 5> kAxes{"X", "Y", "Z", "A", "C"};
  for (int i = 0; i < 5; ++i) {
    auto* name = make_label("muted", card);
    name->setText(QString::fromLatin1(kAxes[static_cast<std::size_t>(i)]));
    auto* box = new NumberField(card);
    box->setRange(-2000, 2000);
    box->setDecimals(3);
    box->setSuffix(i < 3 ? QStringLiteral(" mm") : QStringLiteral(" °"));
    box->setAccessibleName(name->text());
    grid->addWidget(name, i % 3, i / 3 * 2);
    grid->addWidget(box, i % 3, i / 3 * 2 + 1);
    offset_boxes_.push_back(box);
  }
  grid->setColumnStretch(1, 1);
  grid->setColumnStretch(3, 1);
  card->column()->addLayout(grid);
  zero_here_ = make_button(desk_.theme, QStringLiteral("reference"), "", card);
  set_offset_ = make_button(desk_.theme, QStringLiteral("check"), "", card);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(zero_here_, 1);
  buttons->addWidget(set_offset_, 1);
  card->column()->addLayout(buttons);
  card->column()->addStretch(1);
  const auto pose = [this] {
    joblink::Pose p;
    p.set_x_mm(offset_boxes_[0]->value());
    p.set_y_mm(offset_boxes_[1]->value());
    p.set_z_mm(offset_boxes_[2]->value());
    p.set_a_rad(offset_boxes_[3]->value() * kRadPerDeg);
    p.set_c_rad(offset_boxes_[4]->value() * kRadPerDeg);
    return p;
  };
  const auto system = [this] { return static_cast<std::uint32_t>(system_->currentIndex() + 1); };
  connect(zero_here_, &QPushButton::clicked, this,
          [this, system] { desk_.session.set_work_offset(system(), {}, true); });
  connect(set_offset_, &QPushButton::clicked, this,
          [this, pose, system] { desk_.session.set_work_offset(system(), pose(), false); });
  says([this, heading] {
    heading->setText(tr("Work offsets"));
    system_->setAccessibleName(tr("Coordinate system"));
    zero_here_->setText(tr("Zero here"));
    zero_here_->setToolTip(tr("The tool's position becomes the zero of this system"));
    set_offset_->setText(tr("Set"));
    set_offset_->setToolTip(tr("The values above become the zero of this system"));
    take_status();
  });
  return card;
}

void JogPage::take_machine() {
  const auto& machine = desk_.session.machine();
  bool turns = machine.joints_size() == 0;
  for (const auto& joint : machine.joints()) turns = turns || joint.rotary();
  for (QPushButton* button : turn_buttons_) button->setVisible(turns);
}

void JogPage::take_status() {
  if (offset_boxes_.size() < 5 || zero_here_ == nullptr) return;
  const bool connected = desk_.session.connected();
  const joblink::Status& s = desk_.session.status();
  // The focus of a button that can do nothing now (home, while the machine homes) is the page's: arrows jog.
  const auto enable = [this](QPushButton* button, joblink::Command command, bool otherwise = false) {
    const bool can = otherwise || desk_.session.allowed(command);
    if (!can && button->hasFocus()) setFocus();
    set_usable(*button, can, desk_.session.why_not(command));
  };
  for (QPushButton* button : jog_buttons_) enable(button, joblink::COMMAND_JOG);
  // Homing a machine that is off wakes it first.
  const bool wakes = s.state() == joblink::STATE_OFF && desk_.session.allowed(joblink::COMMAND_BRING_UP);
  enable(home_, joblink::COMMAND_HOME, wakes);
  enable(reference_, joblink::COMMAND_REFERENCE);
  enable(hold_, joblink::COMMAND_HOLD);
  enable(clear_, joblink::COMMAND_CLEAR);
  enable(motors_off_, joblink::COMMAND_MOTORS_OFF);
  enable(zero_here_, joblink::COMMAND_JOG);
  enable(set_offset_, joblink::COMMAND_SET_WORK_OFFSET);
  const auto system = static_cast<std::size_t>(s.work_system());
  if (connected && system >= 1 && system <= kSystems.size()) {
    const joblink::Pose& o = s.work_offset();
    const auto mm = [](double v) { return QString::number(v, 'f', 3); };
    active_offset_->setText(
        tr("Active: %1, zero at %2")
            .arg(Format::isolated(QString::fromLatin1(kSystems[system - 1])),
                 Format::isolated(
                     QStringLiteral("X %1  Y %2  Z %3").arg(mm(o.x_mm()), mm(o.y_mm()), mm(o.z_mm())))));
  } else {
    active_offset_->setText(tr("Zeros of the work coordinates"));
  }
}

void JogPage::jog(Axis axis, int sign) {
  if (!desk_.session.allowed(joblink::COMMAND_JOG)) return;
  const double step = kSteps[static_cast<std::size_t>(steps_->checkedId())] * sign;
  joblink::Pose delta;
  bool turn = false;
  switch (axis) {
    case Axis::kX:
      delta.set_x_mm(step);
      break;
    case Axis::kY:
      delta.set_y_mm(step);
      break;
    case Axis::kZ:
      delta.set_z_mm(step);
      break;
    case Axis::kA:
      delta.set_a_rad(step * kRadPerDeg);
      turn = true;
      break;
    case Axis::kC:
      delta.set_c_rad(step * kRadPerDeg);
      turn = true;
      break;
    case Axis::kE:
      delta.set_e_mm(step);
      break;
  }
  desk_.session.jog(delta, turn ? speed_->value() * kRadPerDeg : speed_->value());
}

void JogPage::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
      jog(Axis::kX, -1);
      break;
    case Qt::Key_Right:
      jog(Axis::kX, 1);
      break;
    case Qt::Key_Up:
      jog(Axis::kY, 1);
      break;
    case Qt::Key_Down:
      jog(Axis::kY, -1);
      break;
    case Qt::Key_PageUp:
      jog(Axis::kZ, 1);
      break;
    case Qt::Key_PageDown:
      jog(Axis::kZ, -1);
      break;
    case Qt::Key_A:
      jog(Axis::kA, 1);
      break;
    case Qt::Key_D:
      jog(Axis::kA, -1);
      break;
    case Qt::Key_Q:
      jog(Axis::kC, 1);
      break;
    case Qt::Key_W:
      jog(Axis::kC, -1);
      break;
    case Qt::Key_1:
    case Qt::Key_2:
    case Qt::Key_3:
    case Qt::Key_4:
    case Qt::Key_5:
      steps_->button(event->key() - Qt::Key_1)->setChecked(true);
      break;
    default:
      SpeakingWidget::keyPressEvent(event);
      return;
  }
  event->accept();
}

}  // namespace kinebus::gui
