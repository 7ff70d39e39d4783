#include "gui/views/motors_panel.hpp"

#include <QAbstractItemView>
#include <QChar>
#include <QFrame>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLatin1Char>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QStringList>
#include <QVBoxLayout>
#include <numbers>

#include "gui/models/axes_model.hpp"
#include "gui/models/format.hpp"
#include "gui/views/table_columns.hpp"

namespace kinebus::gui {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr double kMostAmperes = 5;  // 2140h:2
constexpr double kLeastAmperes = 0.05;

NumberField* ampere_field(QWidget* parent, double least) {
  auto* field = new NumberField(parent);
  field->setRange(least, kMostAmperes);
  field->setDecimals(2);
  field->setSingleStep(0.05);
  field->setSuffix(QStringLiteral(" A"));
  return field;
}

}  // namespace

MotorsPanel::MotorsPanel(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* body = new QWidget;
  auto* grid = new QGridLayout(body);
  grid->setContentsMargins(0, 10, 0, 0);
  grid->setSpacing(10);
  grid->addWidget(make_table(), 0, 0, 1, 2);
  grid->addWidget(make_currents(), 1, 0);
  grid->addWidget(make_trial(), 1, 1);
  bench_ = make_label("small", body);
  wrap_words(*bench_);
  grid->addWidget(bench_, 2, 0, 1, 2);
  grid->setRowStretch(0, 1);
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(1, 1);
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(body);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(scroll);
  connect(&desk_.session, &Session::status_changed, this, &MotorsPanel::take_status);
  connect(&desk_.session, &Session::link_changed, this, &MotorsPanel::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &MotorsPanel::take_machine);
  connect(motor_, &QComboBox::currentIndexChanged, this, &MotorsPanel::take_motor);
  says([this] {
    bench_->setText(
        tr("One node on a bench, without a machine file: stop the gateway, then the page Gateways, or %1 on "
           "the computer with the bus, shows, sets, jogs and measures its motors.")
            .arg(Format::isolated(QStringLiteral("kinebus-card"))));
    take_machine();
  });
}

QWidget* MotorsPanel::make_table() {
  table_ = new QTableView(this);
  table_->setModel(&desk_.axes);
  table_->setSelectionMode(QAbstractItemView::NoSelection);
  table_->setFocusPolicy(Qt::TabFocus);
  table_->setTabKeyNavigation(false);
  table_->setShowGrid(false);
  table_->setAlternatingRowColors(true);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(32);
  table_->horizontalHeader()->setHighlightSections(false);
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeading | Qt::AlignVCenter);
  table_->setMinimumHeight(38 + 32 * 6);
  for (const int column : {AxesModel::kMeasured, AxesModel::kError, AxesModel::kByScale,
                           AxesModel::kScaleError, AxesModel::kTravel, AxesModel::kDrive})
    table_->setColumnHidden(column, true);
  new TableColumns(table_);
  says([this] { table_->setAccessibleName(tr("Motors")); });
  return table_;
}

QWidget* MotorsPanel::make_currents() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  motor_ = new QComboBox(card);
  motor_->setLayoutDirection(Qt::LeftToRight);
  turn_with_focus_only(*motor_);
  auto* top = new QHBoxLayout;
  top->addWidget(heading);
  top->addStretch(1);
  top->addWidget(motor_);
  card->column()->addLayout(top);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(6);
  auto* run_name = make_label("muted", card);
  auto* hold_name = make_label("muted", card);
  run_ = ampere_field(card, kLeastAmperes);
  hold_ = ampere_field(card, 0);
  set_ = make_button(desk_.theme, QStringLiteral("check"), "", card);
  grid->addWidget(run_name, 0, 0);
  grid->addWidget(run_, 0, 1);
  grid->addWidget(hold_name, 1, 0);
  grid->addWidget(hold_, 1, 1);
  grid->addWidget(set_, 2, 0, 1, 2);
  grid->setColumnStretch(1, 1);
  card->column()->addLayout(grid);
  card->column()->addStretch(1);
  connect(set_, &QPushButton::clicked, this, [this] {
    desk_.session.set_motor_currents(motor_->currentIndex(), run_->value(), hold_->value());
  });
  says([this, heading, run_name, hold_name] {
    heading->setText(tr("Motor"));
    motor_->setAccessibleName(tr("Motor"));
    run_name->setText(tr("Run current"));
    hold_name->setText(tr("Hold current"));
    run_->setAccessibleName(run_name->text());
    hold_->setAccessibleName(hold_name->text());
    set_->setText(tr("Set currents"));
    set_->setToolTip(tr("Counts when the machine next stands still, and until the gateway is started anew"));
  });
  return card;
}

QWidget* MotorsPanel::make_trial() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  step_ = new NumberField(card);
  step_->setRange(0.01, 20);
  step_->setDecimals(2);
  step_->setValue(1);
  // Less is left and more is right on every machine.
  auto* pad = new QWidget(card);
  pad->setLayoutDirection(Qt::LeftToRight);
  auto* row = new QHBoxLayout(pad);
  row->setContentsMargins(0, 0, 0, 0);
  less_ = make_button(desk_.theme, QStringLiteral("left"), "", pad);
  more_ = make_button(desk_.theme, QStringLiteral("right"), "", pad);
  row->addWidget(less_);
  row->addWidget(step_, 1);
  row->addWidget(more_);
  card->column()->addWidget(pad);
  tune_ = make_button(desk_.theme, QStringLiteral("refresh"), "", card);
  card->column()->addWidget(tune_);
  inputs_ = make_label("muted", card);
  wrap_words(*inputs_);
  card->column()->addWidget(inputs_);
  card->column()->addStretch(1);
  connect(less_, &QPushButton::clicked, this, [this] { jog(-1); });
  connect(more_, &QPushButton::clicked, this, [this] { jog(1); });
  connect(tune_, &QPushButton::clicked, this, [this] { desk_.session.tune_motor(motor_->currentIndex()); });
  says([this, heading] {
    heading->setText(tr("Jog this motor alone"));
    step_->setAccessibleName(tr("Step"));
    less_->setAccessibleName(tr("Jog back"));
    more_->setAccessibleName(tr("Jog on"));
    tune_->setText(tr("Measure the motor"));
    tune_->setToolTip(
        tr("The node measures resistance, inductance and the encoder's offset while the motor stands"));
  });
  return card;
}

const joblink::Joint* MotorsPanel::joint() const {
  const int at = motor_->currentIndex();
  const joblink::MachineInfo& machine = desk_.session.machine();
  return at >= 0 && at < machine.joints_size() ? &machine.joints(at) : nullptr;
}

const joblink::AxisStatus* MotorsPanel::axis() const {
  const joblink::Joint* of = joint();
  if (of == nullptr) return nullptr;
  for (const joblink::NodeStatus& node : desk_.session.status().nodes())
    if (node.id() == of->node() && static_cast<int>(of->axis()) < node.axes_size())
      return &node.axes(static_cast<int>(of->axis()));
  return nullptr;
}

void MotorsPanel::take_machine() {
  QStringList names;
  for (const joblink::Joint& each : desk_.session.machine().joints())
    names << QStringLiteral("%1 (%2 %3)")
                 .arg(QString::fromStdString(each.name()))
                 .arg(Format::number(each.node(), 0))
                 .arg(each.axis() == 0 ? QLatin1Char('A') : QLatin1Char('B'));
  QStringList shown;
  for (int i = 0; i < motor_->count(); ++i) shown << motor_->itemText(i);
  if (names != shown) {
    const QSignalBlocker quiet(motor_);
    motor_->clear();
    motor_->addItems(names);
  }
  take_motor();
}

void MotorsPanel::take_motor() {
  told_run_a_ = told_hold_a_ = 0;
  if (const joblink::Joint* of = joint(); of != nullptr) {
    run_->setValue(of->run_current_a());
    hold_->setValue(of->hold_current_a());
    step_->setSuffix(of->rotary() ? QStringLiteral(" °") : QStringLiteral(" mm"));
    step_->setMaximum(of->rotary() ? 30 : 20);
  }
  take_status();
}

void MotorsPanel::take_status() {
  const Session& session = desk_.session;
  const auto enable = [&](QPushButton& button, joblink::Command command) {
    set_usable(button, joint() != nullptr && session.allowed(command), session.why_not(command));
  };
  enable(*set_, joblink::COMMAND_SET_MOTOR_CURRENTS);
  enable(*less_, joblink::COMMAND_JOG_MOTOR);
  enable(*more_, joblink::COMMAND_JOG_MOTOR);
  enable(*tune_, joblink::COMMAND_TUNE_MOTOR);
  // News of the motor stand in the fields; what is being edited stays.
  const joblink::AxisStatus* has = axis();
  if (has != nullptr && has->run_current_a() > 0 && !run_->hasFocus() && !hold_->hasFocus() &&
      (has->run_current_a() != told_run_a_ || has->hold_current_a() != told_hold_a_)) {
    run_->setValue(told_run_a_ = has->run_current_a());
    hold_->setValue(told_hold_a_ = has->hold_current_a());
  }
  const joblink::Joint* of = joint();
  QString dots;
  if (of != nullptr)
    for (const joblink::NodeStatus& node : session.status().nodes())
      for (unsigned i = 0; node.id() == of->node() && i < 7; ++i)
        dots +=
            Format::isolated(QStringLiteral("%1 %2").arg(
                Format::number(i + 1, 0), (node.inputs() >> i & 1u) != 0 ? QChar(0x25CF) : QChar(0x25CB))) +
            QStringLiteral("  ");
  inputs_->setText(of == nullptr
                       ? QString()
                       : tr("Switches of node %1: %2").arg(Format::number(of->node(), 0), dots.trimmed()));
}

void MotorsPanel::jog(int sign) {
  const joblink::Joint* of = joint();
  if (of == nullptr) return;
  desk_.session.jog_motor(motor_->currentIndex(), sign * step_->value() * (of->rotary() ? kRadPerDegree : 1));
}

}  // namespace kinebus::gui
