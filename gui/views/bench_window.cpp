#include "gui/views/bench_window.hpp"

#include <QChar>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QJsonArray>
#include <QLatin1Char>
#include <QLatin1String>
#include <QLocale>
#include <QVBoxLayout>
#include <array>
#include <cmath>
#include <utility>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

/// Of the usual motor: 200 full steps of 256 counts.
constexpr double kCountsPerTurn = 200 * 256;
constexpr double kMostPhaseAmperes = 5;  // 2140h:2

NumberField* bench_field(double least, double most, double value, const QString& suffix, QWidget* parent) {
  auto* made = new NumberField(parent);
  made->setRange(least, most);
  made->setDecimals(2);
  made->setSingleStep(0.05);
  made->setValue(value);
  made->setSuffix(suffix);
  return made;
}

QString motor_letter(int axis) {
  return axis == 0 ? QStringLiteral("A") : QStringLiteral("B");
}

int milliamperes(const NumberField& field) {
  return static_cast<int>(std::lround(field.value() * 1000));
}

}  // namespace

BenchWindow::BenchWindow(const Theme& theme, const QString& program, QWidget* parent)
    : SpeakingWidget(parent, Qt::Window), theme_(theme), card_(program) {
  setAttribute(Qt::WA_StyledBackground);
  resize(760, 560);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 12, 14, 12);
  column->setSpacing(10);
  column->addWidget(make_head());
  auto* row = new QHBoxLayout;
  row->setSpacing(10);
  for (int axis = 0; axis < 2; ++axis) row->addWidget(make_motor(axis), 1);
  column->addLayout(row);
  switches_ = make_label("muted", this);
  wrap_words(*switches_);
  column->addWidget(switches_);
  news_ = new QLabel(this);
  wrap_words(*news_);
  news_->setTextFormat(Qt::PlainText);
  column->addWidget(news_);
  column->addStretch(1);

  connect(&card_, &BenchCard::state_told, this, &BenchWindow::take_state);
  connect(&card_, &BenchCard::done, this, &BenchWindow::take_done);
  connect(&card_, &BenchCard::refused, this, [this](const QString& why) {
    tell(tr("Refused: %1").arg(Format::isolated(why)));
    say_buttons();
  });
  connect(&card_, &BenchCard::silent, this, [this](const QString& why) {
    state_ = {};
    tell(tr("The card is silent: %1. It is asked again by itself.").arg(Format::isolated(why)));
    say_buttons();
  });
  connect(&card_, &BenchCard::ended, this, [this](const QString& why) {
    state_ = {};
    tell(why.isEmpty() ? tr("Closed. A motor that has power holds on.") : why);
    say_buttons();
  });
  says([this] {
    setWindowTitle(tr("A driver card on a bench"));
    take_state(state_);
  });
}

void BenchWindow::closeEvent(QCloseEvent* event) {
  card_.end();
  SpeakingWidget::closeEvent(event);
}

QWidget* BenchWindow::make_head() {
  auto* box = new Card(this);
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  auto* interface_name = make_label("muted", box);
  auto* node_name = make_label("muted", box);
  interface_ = new QComboBox(box);
  interface_->setEditable(true);
  interface_->setLayoutDirection(Qt::LeftToRight);
  interface_->addItems(BenchCard::interfaces());
  if (interface_->count() == 0) interface_->setEditText(QStringLiteral("can0"));
  turn_with_focus_only(*interface_);
  node_ = new NumberField(box);
  node_->setDecimals(0);
  node_->setRange(1, 126);
  open_ = make_button(theme_, QStringLiteral("gateway"), "primary", box);
  stop_ = make_button(theme_, QStringLiteral("stop"), "danger", box);
  store_ = make_button(theme_, QStringLiteral("save"), "", box);
  row->addWidget(interface_name);
  row->addWidget(interface_, 1);
  row->addWidget(node_name);
  row->addWidget(node_);
  row->addWidget(open_);
  row->addWidget(store_);
  row->addWidget(stop_);
  box->column()->addLayout(row);
  name_ = make_label("muted", box);
  wrap_words(*name_);
  box->column()->addWidget(name_);
  connect(open_, &QPushButton::clicked, this, &BenchWindow::open_or_close);
  connect(stop_, &QPushButton::clicked, this, [this] { card_.send(QStringLiteral("stop")); });
  connect(store_, &QPushButton::clicked, this, [this] {
    card_.send(QStringLiteral("store"));
    say_buttons();
  });
  says([this, interface_name, node_name] {
    interface_name->setText(tr("CAN interface"));
    interface_->setAccessibleName(interface_name->text());
    node_name->setText(tr("Node id"));
    node_->setAccessibleName(node_name->text());
    stop_->setText(tr("Stop the motor"));
    store_->setText(tr("Keep"));
    store_->setToolTip(
        tr("Currents and what was measured are kept through power-off; no motor has power then"));
    say_buttons();
  });
  return box;
}

QWidget* BenchWindow::make_motor(int axis) {
  Motor& m = motors_[static_cast<std::size_t>(axis)];
  auto* box = new Card(this);
  m.heading = make_label("heading", box);
  m.drive = make_label("muted", box);
  m.place = new QLabel(box);
  m.measured = make_label("muted", box);
  wrap_words(*m.measured);
  for (QLabel* label : {m.heading, m.drive, m.place, m.measured}) box->column()->addWidget(label);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(6);
  auto* run_name = make_label("muted", box);
  auto* hold_name = make_label("muted", box);
  auto* turns_name = make_label("muted", box);
  auto* speed_name = make_label("muted", box);
  m.run = bench_field(0, kMostPhaseAmperes, 0, QStringLiteral(" A"), box);
  m.hold = bench_field(0, kMostPhaseAmperes, 0, QStringLiteral(" A"), box);
  m.set = make_button(theme_, QStringLiteral("check"), "", box);
  m.turns = bench_field(0.01, 1000, 1, {}, box);
  m.speed = bench_field(0.01, 50, 1, {}, box);
  m.less = make_button(theme_, QStringLiteral("left"), "", box);
  m.more = make_button(theme_, QStringLiteral("right"), "", box);
  m.power = make_button(theme_, QStringLiteral("power"), "", box);
  m.tune = make_button(theme_, QStringLiteral("refresh"), "", box);
  grid->addWidget(run_name, 0, 0);
  grid->addWidget(m.run, 0, 1);
  grid->addWidget(hold_name, 1, 0);
  grid->addWidget(m.hold, 1, 1);
  grid->addWidget(m.set, 2, 0, 1, 2);
  grid->addWidget(turns_name, 3, 0);
  grid->addWidget(m.turns, 3, 1);
  grid->addWidget(speed_name, 4, 0);
  grid->addWidget(m.speed, 4, 1);
  // Back is left and on is right, as numbers are.
  auto* pad = new QWidget(box);
  pad->setLayoutDirection(Qt::LeftToRight);
  auto* row = new QHBoxLayout(pad);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(m.less);
  row->addWidget(m.more);
  grid->addWidget(pad, 5, 0, 1, 2);
  grid->addWidget(m.power, 6, 0);
  grid->addWidget(m.tune, 6, 1);
  grid->setColumnStretch(1, 1);
  box->column()->addLayout(grid);
  box->column()->addStretch(1);
  connect(m.set, &QPushButton::clicked, this, [this, axis] {
    const Motor& motor = motors_[static_cast<std::size_t>(axis)];
    send(QStringLiteral("current"), axis,
         QStringLiteral(" %1 %2").arg(milliamperes(*motor.run)).arg(milliamperes(*motor.hold)));
  });
  connect(m.less, &QPushButton::clicked, this, [this, axis] { jog(axis, -1); });
  connect(m.more, &QPushButton::clicked, this, [this, axis] { jog(axis, 1); });
  connect(m.power, &QPushButton::clicked, this, [this, axis] {
    send(motors_[static_cast<std::size_t>(axis)].has_power ? QStringLiteral("off") : QStringLiteral("on"),
         axis);
  });
  connect(m.tune, &QPushButton::clicked, this, [this, axis] { send(QStringLiteral("tune"), axis); });
  says([this, axis, run_name, hold_name, turns_name, speed_name] {
    const Motor& motor = motors_[static_cast<std::size_t>(axis)];
    motor.heading->setText(tr("Motor %1").arg(motor_letter(axis)));
    run_name->setText(tr("Run current"));
    hold_name->setText(tr("Hold current"));
    turns_name->setText(tr("Turns"));
    speed_name->setText(tr("Turns a second"));
    motor.run->setAccessibleName(run_name->text());
    motor.hold->setAccessibleName(hold_name->text());
    motor.turns->setAccessibleName(turns_name->text());
    motor.speed->setAccessibleName(speed_name->text());
    motor.turns->setToolTip(tr("Of a motor with 200 steps a turn"));
    motor.set->setText(tr("Set currents"));
    motor.less->setText(tr("Back"));
    motor.more->setText(tr("On"));
    motor.less->setAccessibleName(tr("Turn motor %1 back").arg(motor_letter(axis)));
    motor.more->setAccessibleName(tr("Turn motor %1 on").arg(motor_letter(axis)));
    motor.tune->setText(tr("Measure the motor"));
    motor.tune->setToolTip(
        tr("The node measures resistance, inductance and the encoder's offset while the motor stands"));
  });
  return box;
}

void BenchWindow::open_or_close() {
  if (card_.runs()) {
    card_.end();
  } else {
    tell({});
    card_.start(interface_->currentText().trimmed(), static_cast<int>(std::lround(node_->value())));
  }
  say_buttons();
}

void BenchWindow::say_buttons() {
  const bool runs = card_.runs(), there = !state_.isEmpty(), free = there && !card_.busy();
  open_->setText(runs ? tr("Close") : tr("Open"));
  interface_->setEnabled(!runs);
  node_->setEnabled(!runs);
  stop_->setEnabled(there);
  store_->setEnabled(free);
  for (const Motor& m : motors_) {
    if (m.set == nullptr) continue;
    for (QPushButton* button : {m.set, m.less, m.more, m.power, m.tune}) button->setEnabled(free);
    m.power->setText(m.has_power ? tr("Let go") : tr("Hold"));
  }
}

void BenchWindow::take_state(const QJsonObject& state) {
  const bool first = state_.isEmpty() && !state.isEmpty();
  state_ = state;
  if (first) tell({});
  name_->setText(
      state.isEmpty()
          ? tr("Without gateway and machine file: this computer's CAN interface, and the node's id.")
          : tr("%1, serial number %2")
                .arg(Format::isolated(state.value(QLatin1String("name")).toString()),
                     Format::number(state.value(QLatin1String("serial")).toDouble(), 0)));
  const QJsonArray motors = state.value(QLatin1String("motors")).toArray();
  for (int axis = 0; axis < 2; ++axis) take_motor(axis, motors.at(axis).toObject());
  QString dots;
  const QJsonArray switches = state.value(QLatin1String("switches")).toArray();
  for (int i = 0; i < switches.size(); ++i) {
    const bool active = switches.at(i).toObject().value(QLatin1String("active")).toBool();
    dots += Format::isolated(
                QStringLiteral("%1 %2").arg(Format::number(i + 1, 0), QChar(active ? 0x25CF : 0x25CB))) +
            QStringLiteral("  ");
  }
  QString words = state.isEmpty() ? QString() : tr("Switches: %1").arg(dots.trimmed());
  QString codes;
  for (const auto& code : state.value(QLatin1String("errors")).toArray())
    codes += QStringLiteral("%1h ")
                 .arg(code.toInt(), 4, 16, QLatin1Char('0'))
                 .toUpper()
                 .replace(QLatin1Char('H'), QLatin1Char('h'));
  if (!codes.isEmpty())
    words += QLatin1Char('\n') + tr("Errors that it has told: %1").arg(Format::isolated(codes.trimmed()));
  switches_->setText(words);
  say_buttons();
}

QString BenchWindow::drive_state(const QString& word) {
  // As CiA 402 names them.
  const std::array<std::pair<const char*, QString>, 8> states{
      {{"not ready to switch on", tr("not ready")},
       {"switch on disabled", tr("switched off")},
       {"ready to switch on", tr("ready to switch on")},
       {"switched on", tr("switched on, without current")},
       {"operation enabled", tr("holds")},
       {"quick stop active", tr("stopped")},
       {"fault reaction active", tr("stops with a fault")},
       {"fault", tr("fault")}}};
  for (const auto& [name, said] : states)
    if (word == QLatin1String(name)) return said;
  return Format::isolated(word);
}

void BenchWindow::take_motor(int axis, const QJsonObject& state) {
  Motor& m = motors_[static_cast<std::size_t>(axis)];
  m.has_power = state.value(QLatin1String("has_power")).toBool();
  if (state.isEmpty()) {
    m.drive->setText(QStringLiteral("—"));
    m.place->setText({});
    m.measured->setText({});
    m.told_run_ma = m.told_hold_ma = -1;
    return;
  }
  const auto number = [&](const char* key) { return state.value(QLatin1String(key)).toDouble(); };
  const int error = state.value(QLatin1String("error_code")).toInt();
  const QString drive = drive_state(state.value(QLatin1String("drive")).toString());
  m.drive->setText(error == 0 ? drive
                              : tr("%1, error %2")
                                    .arg(drive, Format::isolated(QStringLiteral("%1h").arg(
                                                    error, 4, 16, QLatin1Char('0')))));
  const double counts = number("position_counts");
  m.place->setText(tr("%1 counts, %2 turns")
                       .arg(Format::isolated(Format::number(counts, 0)),
                            Format::isolated(Format::number(counts / kCountsPerTurn, 3))));
  m.measured->setText(
      tr("%1 measured, stage at %2, supply %3")
          .arg(Format::isolated(Format::number(number("measured_ma") / 1000, 2) + QStringLiteral(" A")),
               Format::isolated(Format::temperature(number("stage_celsius"))),
               Format::isolated(Format::number(number("supply_volts"), 1) + QStringLiteral(" V"))));
  // News stand in the fields; what is being edited stays.
  const int run = static_cast<int>(number("run_ma")), hold = static_cast<int>(number("hold_ma"));
  if ((run != m.told_run_ma || hold != m.told_hold_ma) && !m.run->hasFocus() && !m.hold->hasFocus()) {
    m.told_run_ma = run;
    m.told_hold_ma = hold;
    m.run->setValue(run * 1e-3);
    m.hold->setValue(hold * 1e-3);
  }
}

void BenchWindow::take_done(const QString& what, const QJsonObject& found) {
  const auto number = [&](const char* key) { return found.value(QLatin1String(key)).toDouble(); };
  if (what.startsWith(QLatin1String("tune"))) {
    const double offset = number("encoder_offset");
    const QString winding =
        Format::isolated(Format::number(number("resistance_mohm") / 1000, 3) + QStringLiteral(" Ω, ") +
                         Format::number(number("inductance_uh") / 1000, 3) + QStringLiteral(" mH"));
    tell(offset < 0 ? tr("Measured: %1, no encoder").arg(winding)
                    : tr("Measured: %1, encoder offset %2").arg(winding, Format::number(offset, 0)));
  } else if (what == QLatin1String("store")) {
    tell(tr("The card keeps its settings through power-off."));
  } else if (found.value(QLatin1String("stopped")).toBool()) {
    tell(tr("Stopped by its ramp; the motor holds."));
  } else {
    tell({});
  }
  say_buttons();
}

void BenchWindow::tell(const QString& words) {
  news_->setText(words);
}

void BenchWindow::jog(int axis, int sign) {
  const Motor& m = motors_[static_cast<std::size_t>(axis)];
  send(QStringLiteral("jog"), axis,
       QStringLiteral(" %1 %2")
           .arg(std::llround(sign * m.turns->value() * kCountsPerTurn))
           .arg(std::llround(m.speed->value() * kCountsPerTurn)));
}

void BenchWindow::send(const QString& verb, int axis, const QString& more) {
  card_.send(verb + QLatin1Char(' ') + motor_letter(axis) + more);
  say_buttons();
}

}  // namespace kinebus::gui
