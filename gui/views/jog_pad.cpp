#include "gui/views/jog_pad.hpp"

#include <QAbstractButton>
#include <QChar>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLatin1Char>
#include <QLocale>
#include <QPushButton>
#include <QStringList>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>
#include <QtMath>
#include <array>
#include <chrono>
#include <utility>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {
using namespace std::chrono_literals;

constexpr std::array<double, 5> kSteps{0.01, 0.1, 1, 10, 50};

/// A key that is down for longer is held, not clicked.
constexpr auto kLongEnough = 300ms;
/// The gateway ends a jog of which it has not heard for 200 ms.
constexpr auto kAgain = 60ms;
/// Farther than any machine goes: mm, and a turn in degrees.
constexpr double kFar = 1000;
constexpr double kFarTurn = 360;
}  // namespace

JogPad::JogPad(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk), drive_(desk.session) {
  auto* card = new Card(this);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(card);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  auto* centred = new QHBoxLayout;
  centred->addStretch(1);
  centred->addWidget(make_keys(card));
  centred->addStretch(1);
  card->column()->addLayout(centred);
  card->column()->addWidget(make_steps());
  hint_ = make_label("small", card);
  wrap_words(*hint_);
  card->column()->addWidget(hint_);
  by_hand_ = new QCheckBox(card);
  by_hand_hint_ = make_label("small", card);
  wrap_words(*by_hand_hint_);
  card->column()->addWidget(by_hand_);
  card->column()->addWidget(by_hand_hint_);
  card->column()->addStretch(1);
  connect(by_hand_, &QCheckBox::toggled, this, [this](bool on) {
    if (!on) drive_.take({});
  });
  connect(speed_, &NumberField::valueChanged, &drive_, &JogDrive::set_full_speed);
  drive_.set_full_speed(speed_->value());
  for (auto& device : make_jog_devices()) follow(std::move(device));
  says([this, heading] {
    heading->setText(tr("Jog"));
    hint_->setText(
        tr("A click is a step; a button or key that is held moves until it is let go. Keys: arrows move X "
           "and Y, "
           "Page Up and Page Down move Z, A and D tilt, Q and W turn the table, 1 to 5 choose the step."));
    tell_devices();
  });
  long_enough_.setSingleShot(true);
  long_enough_.setInterval(kLongEnough);
  again_.setInterval(kAgain);
  connect(&long_enough_, &QTimer::timeout, this, &JogPad::keep_moving);
  connect(&again_, &QTimer::timeout, this, &JogPad::keep_moving);
  // A way that ends before the key does is not begun anew.
  connect(&desk_.session, &Session::refused, this, &JogPad::let_go);
  connect(&desk_.session, &Session::link_changed, this, &JogPad::let_go);
  connect(&desk_.session, &Session::link_changed, this, &JogPad::take_status);
  connect(&desk_.session, &Session::status_changed, this, &JogPad::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &JogPad::take_machine);
  take_machine();
  take_status();
}

QPushButton* JogPad::jog_button(Way way, const QString& icon) {
  auto* button = make_button(desk_.theme, icon, "jog", this);
  static constexpr std::array<const char*, 6> kNames{"X", "Y", "Z", "A", "C", "E"};
  const QString name = QString::fromLatin1(kNames[static_cast<std::size_t>(way.axis)]) +
                       (way.sign > 0 ? QLatin1Char('+') : QChar(0x2212));
  button->setText(Format::isolated(name));
  button->setLayoutDirection(Qt::LeftToRight);
  button->setAccessibleName(name);
  connect(button, &QPushButton::pressed, this, [this, way] { press(way); });
  connect(button, &QPushButton::released, this, [this, way] { release(way); });
  jog_buttons_.push_back(button);
  if (way.axis == Axis::kA || way.axis == Axis::kC) turn_buttons_.push_back(button);
  return button;
}

QWidget* JogPad::make_keys(QWidget* parent) {
  // Left is left on the machine, whatever the language.
  auto* pad = new QWidget(parent);
  pad->setLayoutDirection(Qt::LeftToRight);
  auto* grid = new QGridLayout(pad);
  grid->setContentsMargins(0, 6, 0, 6);
  grid->setSpacing(6);
  const auto key = [](const char* name) { return QString::fromLatin1(name); };
  grid->addWidget(jog_button({Axis::kY, 1}, key("up")), 0, 1);
  grid->addWidget(jog_button({Axis::kX, -1}, key("left")), 1, 0);
  grid->addWidget(jog_button({Axis::kX, 1}, key("right")), 1, 2);
  grid->addWidget(jog_button({Axis::kY, -1}, key("down")), 2, 1);
  grid->addWidget(jog_button({Axis::kZ, 1}, key("up")), 0, 4);
  grid->addWidget(jog_button({Axis::kZ, -1}, key("down")), 2, 4);
  grid->addWidget(jog_button({Axis::kA, 1}, key("turn-left")), 0, 6);
  grid->addWidget(jog_button({Axis::kA, -1}, key("turn-right")), 2, 6);
  grid->addWidget(jog_button({Axis::kC, 1}, key("turn-left")), 0, 7);
  grid->addWidget(jog_button({Axis::kC, -1}, key("turn-right")), 2, 7);
  grid->addWidget(jog_button({Axis::kE, 1}, key("up")), 0, 9);
  grid->addWidget(jog_button({Axis::kE, -1}, key("down")), 2, 9);
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
  return pad;
}

QWidget* JogPad::make_steps() {
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
    speed_->setAccessibleName(tr("Speed"));
    speed_->setSuffix(QStringLiteral(" ") + tr("mm/s"));
    for (std::size_t i = 0; i < kSteps.size(); ++i)
      buttons[static_cast<int>(i)]->setText(QLocale().toString(kSteps[i], 'g', 4));
  });
  return box;
}

void JogPad::follow(std::unique_ptr<JogDevice> device) {
  JogDevice* const added = device.get();
  devices_.push_back(std::move(device));
  connect(added, &JogDevice::name_changed, this, &JogPad::tell_devices);
  connect(added, &JogDevice::deflected, this,
          [this, added](const JogDevice::Deflection& deflection) { take_deflection(*added, deflection); });
  added->listen(isVisible());
  tell_devices();
}

void JogPad::tell_devices() {
  QStringList names;
  bool dead_man = false;
  for (const auto& device : devices_) {
    if (device->name().isEmpty()) continue;
    names << Format::isolated(device->name());
    dead_man = dead_man || device->has_dead_man();
  }
  by_hand_->setVisible(!names.isEmpty());
  by_hand_hint_->setVisible(!names.isEmpty());
  // What comes back is switched on anew.
  if (names.isEmpty()) by_hand_->setChecked(false);
  by_hand_->setText(tr("Move by %1").arg(names.join(QStringLiteral(", "))));
  by_hand_hint_->setText(
      dead_man ? tr("It moves while it is deflected and its left shoulder key is held: left stick X and Y, "
                    "right stick Z and C; a little is slow.")
               : tr("It moves while it is deflected, along one axis at a time; a little is slow."));
}

void JogPad::take_deflection(const JogDevice& device, const JogDevice::Deflection& deflection) {
  const bool listens = by_hand_->isChecked() && isVisible() && window()->isActiveWindow() && !pressed_ &&
                       !device.name().isEmpty();
  drive_.take(listens ? deflection : JogDevice::Deflection{});
}

void JogPad::showEvent(QShowEvent* event) {
  for (const auto& device : devices_) device->listen(true);
  SpeakingWidget::showEvent(event);
}

void JogPad::hideEvent(QHideEvent* event) {
  drive_.take({});
  for (const auto& device : devices_) device->listen(false);
  SpeakingWidget::hideEvent(event);
}

void JogPad::take_machine() {
  const auto& machine = desk_.session.machine();
  bool turns = machine.joints_size() == 0;
  for (const auto& joint : machine.joints()) turns = turns || joint.rotary();
  for (QPushButton* button : turn_buttons_) button->setVisible(turns);
}

void JogPad::take_status() {
  const bool can = desk_.session.allowed(joblink::COMMAND_JOG);
  for (QPushButton* button : jog_buttons_) {
    // The focus of a button that can do nothing now is the page's: arrows jog.
    if (!can && button->hasFocus() && parentWidget() != nullptr) parentWidget()->setFocus();
    set_usable(*button, can, desk_.session.why_not(joblink::COMMAND_JOG));
  }
}

void JogPad::press(Way way) {
  if (pressed_ || !desk_.session.allowed(joblink::COMMAND_JOG)) return;
  pressed_ = way;
  long_enough_.start();
}

void JogPad::release(Way way) {
  if (pressed_ != way) return;
  if (!moving_) send(way, kSteps[static_cast<std::size_t>(steps_->checkedId())], false);
  let_go();
}

void JogPad::let_go() {
  drive_.let_go();
  long_enough_.stop();
  again_.stop();
  const std::optional<Way> way = std::exchange(pressed_, std::nullopt);
  if (std::exchange(moving_, false) && way && desk_.session.connected()) send(*way, 0, true);
}

void JogPad::keep_moving() {
  if (!pressed_) return;
  moving_ = true;
  again_.start();
  const bool turn = pressed_->axis == Axis::kA || pressed_->axis == Axis::kC;
  send(*pressed_, turn ? kFarTurn : kFar, true);
}

/// `distance`: mm or degrees, at least 0.
void JogPad::send(Way way, double distance, bool held) {
  const double step = distance * way.sign;
  joblink::Pose delta;
  bool turn = false;
  switch (way.axis) {
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
      delta.set_a_rad(qDegreesToRadians(step));
      turn = true;
      break;
    case Axis::kC:
      delta.set_c_rad(qDegreesToRadians(step));
      turn = true;
      break;
    case Axis::kE:
      delta.set_e_mm(step);
      break;
  }
  desk_.session.jog(delta, turn ? qDegreesToRadians(speed_->value()) : speed_->value(), held);
}

std::optional<JogPad::Way> JogPad::way_of(int key) {
  switch (key) {
    case Qt::Key_Left:
      return Way{Axis::kX, -1};
    case Qt::Key_Right:
      return Way{Axis::kX, 1};
    case Qt::Key_Up:
      return Way{Axis::kY, 1};
    case Qt::Key_Down:
      return Way{Axis::kY, -1};
    case Qt::Key_PageUp:
      return Way{Axis::kZ, 1};
    case Qt::Key_PageDown:
      return Way{Axis::kZ, -1};
    case Qt::Key_A:
      return Way{Axis::kA, 1};
    case Qt::Key_D:
      return Way{Axis::kA, -1};
    case Qt::Key_Q:
      return Way{Axis::kC, 1};
    case Qt::Key_W:
      return Way{Axis::kC, -1};
    default:
      return std::nullopt;
  }
}

bool JogPad::key(const QKeyEvent& event) {
  const bool down = event.type() == QEvent::KeyPress;
  if (event.key() >= Qt::Key_1 && event.key() <= Qt::Key_5) {
    if (down) steps_->button(event.key() - Qt::Key_1)->setChecked(true);
    return true;
  }
  const auto way = way_of(event.key());
  if (!way) return false;
  // The keyboard's own repetition is neither a click nor an end.
  if (event.isAutoRepeat()) return true;
  if (down)
    press(*way);
  else
    release(*way);
  return true;
}

}  // namespace kinebus::gui
