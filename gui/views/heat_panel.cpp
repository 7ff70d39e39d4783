#include "gui/views/heat_panel.hpp"

#include <QAbstractButton>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QMessageBox>
#include <QSignalBlocker>
#include <QSizePolicy>
#include <QStringList>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "gui/models/format.hpp"
#include "gui/session/gateway_words.hpp"

namespace kinebus::gui {
HeatPanel::HeatPanel(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 10, 0, 0);
  grid->setSpacing(10);
  grid->addWidget(make_choice(), 0, 0);
  grid->addWidget(make_result(), 1, 0);
  grid->addWidget(make_curve(), 0, 1, 2, 1);
  grid->setRowStretch(1, 1);
  grid->setColumnStretch(0, 2);
  grid->setColumnStretch(1, 3);
  connect(&desk_.session, &Session::status_changed, this, &HeatPanel::take_status);
  connect(&desk_.session, &Session::link_changed, this, &HeatPanel::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &HeatPanel::take_machine);
  connect(heater_, &QComboBox::currentIndexChanged, this, &HeatPanel::take_heater);
  says([this] { take_machine(); });
}

QWidget* HeatPanel::make_choice() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  auto* what = make_label("small", card);
  wrap_words(*what);
  card->column()->addWidget(heading);
  card->column()->addWidget(what);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(6);
  grid->setColumnStretch(1, 1);
  const auto name = [&](int row, QWidget* of) {
    auto* label = make_label("muted", card);
    grid->addWidget(label, row, 0);
    grid->addWidget(of, row, 1);
    return label;
  };
  heater_ = new QComboBox(card);
  turn_with_focus_only(*heater_);
  target_ = new NumberField(card);
  target_->setDecimals(0);
  target_->setSingleStep(5);
  target_->setSuffix(QStringLiteral(" °C"));
  actual_ = new QLabel(card);
  auto* heater_name = name(0, heater_);
  auto* target_name = name(1, target_);
  auto* actual_name = name(2, actual_);
  card->column()->addLayout(grid);
  measure_ = make_button(desk_.theme, QStringLiteral("play"), "primary", card);
  give_up_ = make_button(desk_.theme, QStringLiteral("cancel"), "danger", card);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(measure_, 1);
  buttons->addWidget(give_up_, 1);
  card->column()->addLayout(buttons);
  connect(target_, &NumberField::refused, &desk_.session, &Session::refused);
  connect(measure_, &QPushButton::clicked, this, &HeatPanel::ask_to_measure);
  connect(give_up_, &QPushButton::clicked, this, &HeatPanel::give_up);
  says([=, this] {
    heading->setText(tr("Measure a heater"));
    what->setText(
        tr("Its node heats it with full power for half of the way, switches it off and follows its curve. "
           "What it finds makes the heater reach its target fast, without going beyond it."));
    heater_name->setText(tr("Heater"));
    heater_->setAccessibleName(heater_name->text());
    target_name->setText(tr("Good at"));
    target_->setAccessibleName(tr("Temperature that it shall be good at"));
    actual_name->setText(tr("It is at"));
    measure_->setText(tr("Measure"));
    give_up_->setText(tr("End"));
    give_up_->setToolTip(tr("Ends the measurement: the heater is switched off and stays as it was"));
  });
  return card;
}

QWidget* HeatPanel::make_curve() {
  auto* card = new Card(this);
  stage_ = make_label("heading", card);
  wrap_words(*stage_);
  progress_ = new QProgressBar(card);
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  plot_ = new TuningPlot(desk_.theme, card);
  card->column()->addWidget(stage_);
  card->column()->addWidget(progress_);
  card->column()->addWidget(plot_, 1);
  says([this] {
    plot_->setAccessibleName(tr("Temperature while it is measured"));
    progress_->setAccessibleName(tr("Progress"));
  });
  return card;
}

QWidget* HeatPanel::make_result() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  card->column()->addWidget(heading);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(10);
  grid->setVerticalSpacing(5);
  grid->setColumnStretch(1, 1);
  const auto fact = [&](auto title, auto words) {
    auto* name = make_label("muted", card);
    auto* value = new QLabel(card);
    grid->addWidget(name, static_cast<int>(facts_.size()), 0);
    grid->addWidget(value, static_cast<int>(facts_.size()), 1);
    facts_.push_back({value, words});
    says([name, value, title] {
      name->setText(title());
      align_trailing(*value);
    });
  };
  using T = joblink::HeaterTuning;
  fact([] { return tr("Power, by the machine file"); },
       [](const T& t) { return tr("%1 W").arg(Format::number(t.power_w(), 1)); });
  fact([] { return tr("Heat capacity"); },
       [](const T& t) { return tr("%1 J/K").arg(Format::number(t.capacity_j_per_k(), 1)); });
  fact([] { return tr("Loss"); },
       [](const T& t) { return tr("%1 W/K").arg(Format::number(t.loss_w_per_k(), 3)); });
  fact([] { return tr("Dead time"); },
       [](const T& t) { return tr("%1 s").arg(Format::number(t.dead_s(), 2)); });
  fact([] { return tr("Lag"); }, [](const T& t) { return tr("%1 s").arg(Format::number(t.lag_s(), 2)); });
  card->column()->addLayout(grid);
  kept_ = make_label("small", card);
  wrap_words(*kept_);
  card->column()->addWidget(kept_);
  card->column()->addStretch(1);
  says([heading] { heading->setText(tr("What was found")); });
  return card;
}

const joblink::HeaterInfo* HeatPanel::chosen() const {
  const int at = heater_->currentIndex();
  const joblink::MachineInfo& machine = desk_.session.machine();
  return at >= 0 && at < machine.heaters_size() ? &machine.heaters(at) : nullptr;
}

const joblink::Heater* HeatPanel::heater() const {
  const joblink::HeaterInfo* info = chosen();
  if (info == nullptr) return nullptr;
  for (const joblink::Heater& each : desk_.session.status().heaters())
    if (each.name() == info->name()) return &each;
  return nullptr;
}

const joblink::Heater* HeatPanel::measured() const {
  for (const joblink::Heater& each : desk_.session.status().heaters())
    if (measures(each.tuning().stage())) return &each;
  return nullptr;
}

void HeatPanel::take_machine() {
  QStringList names, shown;
  for (const joblink::HeaterInfo& each : desk_.session.machine().heaters())
    names << QString::fromStdString(each.name());
  for (int i = 0; i < heater_->count(); ++i) shown << heater_->itemText(i);
  if (names != shown) {
    const QSignalBlocker quiet(heater_);
    heater_->clear();
    heater_->addItems(names);
    take_heater();
  } else {
    take_status();
  }
}

void HeatPanel::take_heater() {
  if (const joblink::HeaterInfo* info = chosen(); info != nullptr) {
    target_->setRange(0, info->max_celsius() > 0 ? info->max_celsius() : 300);
    target_->setValue(info->usual_celsius());
  }
  take_status();
}

void HeatPanel::take_status() {
  const Session& session = desk_.session;
  const joblink::Heater* of = heater();
  actual_->setText(of != nullptr && session.connected()
                       ? Format::isolated(Format::temperature(of->actual_celsius()))
                       : QStringLiteral("—"));
  // Whoever began it: what is measured now is what is shown.
  if (of != nullptr && measures(of->tuning().stage())) target_->setValue(of->tuning().celsius());
  set_usable(*measure_, chosen() != nullptr && session.allowed(joblink::COMMAND_TUNE_HEATER),
             session.why_not(joblink::COMMAND_TUNE_HEATER));
  give_up_->setEnabled(session.connected() && measured() != nullptr &&
                       session.allowed(joblink::COMMAND_SET_TEMPERATURE));
  heater_->setEnabled(chosen() != nullptr);
  target_->setEnabled(chosen() != nullptr && measured() == nullptr);
  tell_stage(of);
}

void HeatPanel::tell_stage(const joblink::Heater* of) {
  const TuningCurve* curve = of != nullptr ? desk_.tuning.of(of->name()) : nullptr;
  plot_->show_curve(curve);
  const joblink::HeaterTuning none;
  const joblink::HeaterTuning& tuning = of != nullptr ? of->tuning() : none;
  const bool done = tuning.stage() == joblink::TUNING_DONE;
  const auto put = [](QLabel* label, const QString& words) {
    if (label->text() != words) label->setText(words);
  };
  for (const Fact& fact : facts_)
    put(fact.value, done ? Format::isolated(fact.words(tuning)) : QStringLiteral("—"));
  const QString why = GatewayWords::said(tuning.failure(), {});
  QString stage, kept;
  switch (tuning.stage()) {
    case joblink::TUNING_BEGINS:
      stage = tr("The measurement begins");
      break;
    case joblink::TUNING_HEATS:
      stage = tr("It heats with full power");
      break;
    case joblink::TUNING_COOLS:
      stage = tr("The power is off, its curve is followed");
      break;
    case joblink::TUNING_FITS:
    case joblink::TUNING_KEEPS:
      stage = tr("The node works out what it has seen, and stores it");
      break;
    case joblink::TUNING_DONE:
      stage = tr("Measured, to be good at %1").arg(Format::isolated(Format::temperature(tuning.celsius())));
      kept = why.isEmpty()
                 ? tr("The heater's node works by these values from now on, and keeps them without power.")
                 : tr("The heater's node works by these values from now on. %1").arg(why);
      break;
    case joblink::TUNING_FAILED:
      stage = tr("Not measured");
      kept = why;
      break;
    default:
      stage =
          of != nullptr ? tr("Not measured since the gateway was started") : tr("This machine has no heater");
      break;
  }
  put(stage_, stage);
  put(kept_, kept);
  progress_->setValue(curve != nullptr && measures(tuning.stage())
                          ? static_cast<int>(std::lround(progress_of(*curve) * 1000))
                          : (done ? 1000 : 0));
}

void HeatPanel::ask_to_measure() {
  const joblink::HeaterInfo* info = chosen();
  if (info == nullptr) return;
  const joblink::HeaterInfo asked = *info;
  const double celsius = target_->value();
  auto* question = new QMessageBox(
      QMessageBox::Question, tr("Measure a heater"),
      tr("%1 gets full power until it is half of the way to %2. It is hot then, and the machine does "
         "nothing else for some minutes. Its fan should blow as it does in a print.")
          .arg(Format::isolated(QString::fromStdString(asked.name())),
               Format::isolated(Format::temperature(celsius))),
      QMessageBox::NoButton, window());
  question->setAttribute(Qt::WA_DeleteOnClose);
  auto* yes = question->addButton(tr("Measure"), QMessageBox::AcceptRole);
  auto* no = question->addButton(tr("Not now"), QMessageBox::RejectRole);
  question->setDefaultButton(no);
  question->setEscapeButton(no);
  connect(yes, &QAbstractButton::clicked, this,
          [this, asked, celsius] { desk_.session.tune_heater(asked.kind(), asked.index(), celsius); });
  question->open();
}

void HeatPanel::give_up() {
  if (const joblink::Heater* of = measured(); of != nullptr)
    desk_.session.set_heater(of->kind(), of->index(), 0);
}

}  // namespace kinebus::gui
