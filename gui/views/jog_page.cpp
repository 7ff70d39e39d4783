#include "gui/views/jog_page.hpp"

#include <QAbstractButton>
#include <QEvent>
#include <QFocusEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLatin1Char>
#include <QLocale>
#include <QMargins>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>
#include <algorithm>
#include <array>
#include <numbers>

#include "gui/models/format.hpp"
#include "gui/views/filament_keys.hpp"

namespace kinebus::gui {
namespace {
constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr std::array<const char*, 9> kSystems{"G54", "G55",   "G56",   "G57",  "G58",
                                              "G59", "G59.1", "G59.2", "G59.3"};
}  // namespace

JogPage::JogPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  setFocusPolicy(Qt::StrongFocus);
  auto* body = new QWidget;
  grid_ = new QGridLayout(body);
  grid_->setContentsMargins(14, 12, 14, 12);
  grid_->setSpacing(12);
  pad_ = new JogPad(desk_, body);
  actions_ = make_actions();
  offsets_ = make_offsets();
  arrange();
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(body);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(scroll);
  connect(&desk_.session, &Session::status_changed, this, &JogPage::take_status);
  connect(&desk_.session, &Session::link_changed, this, &JogPage::take_status);
  for (QAbstractButton* button : findChildren<QAbstractButton*>()) {
    button->installEventFilter(this);
    button->setFocusPolicy(Qt::TabFocus);  // the page keeps the keys when a button is clicked
  }
  take_status();
}

/// Beside one another, or where there is too little room below.
void JogPage::arrange() {
  const QMargins margins = grid_->contentsMargins();
  const int wanted = pad_->minimumSizeHint().width() + grid_->spacing() + margins.left() + margins.right() +
                     std::max(actions_->minimumSizeHint().width(), offsets_->minimumSizeHint().width());
  const Shape shape = width() >= wanted ? Shape::kBeside : Shape::kBelow;
  if (shape == shape_) return;
  shape_ = shape;
  for (QWidget* card : {static_cast<QWidget*>(pad_), actions_, offsets_}) grid_->removeWidget(card);
  const bool beside = shape == Shape::kBeside;
  grid_->addWidget(pad_, 0, 0, beside ? 2 : 1, 1);
  grid_->addWidget(actions_, beside ? 0 : 1, beside ? 1 : 0);
  grid_->addWidget(offsets_, beside ? 1 : 2, beside ? 1 : 0);
  grid_->setColumnStretch(0, 3);
  grid_->setColumnStretch(1, beside ? 2 : 0);
  grid_->setRowStretch(1, beside ? 1 : 0);
}

void JogPage::resizeEvent(QResizeEvent* event) {
  SpeakingWidget::resizeEvent(event);
  arrange();
}

/// A button that has the focus would take arrows for a way to the next button: they jog.
bool JogPage::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress && event->type() != QEvent::KeyRelease)
    return SpeakingWidget::eventFilter(watched, event);
  auto* key = static_cast<QKeyEvent*>(event);
  const bool arrow = key->key() == Qt::Key_Left || key->key() == Qt::Key_Right || key->key() == Qt::Key_Up ||
                     key->key() == Qt::Key_Down;
  if (!arrow || key->modifiers() != Qt::NoModifier) return SpeakingWidget::eventFilter(watched, event);
  pad_->key(*key);
  return true;
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
  card->column()->addWidget(make_pin(card));
  auto* filament_heading = make_label("muted", card);
  auto* filament = new FilamentKeys(desk_, card);
  card->column()->addWidget(filament_heading);
  card->column()->addWidget(filament);
  const auto take_filament = [filament_heading, filament] {
    filament_heading->setVisible(filament->is_of_use());
    filament->setVisible(filament->is_of_use());
  };
  connect(&desk_.session, &Session::machine_changed, filament, take_filament);
  take_filament();
  connect(home_, &QPushButton::clicked, &desk_.session, &Session::home);
  connect(reference_, &QPushButton::clicked, &desk_.session, &Session::go_to_reference);
  connect(hold_, &QPushButton::clicked, &desk_.session, &Session::hold);
  connect(clear_, &QPushButton::clicked, &desk_.session, &Session::clear);
  connect(motors_off_, &QPushButton::clicked, &desk_.session, &Session::motors_off);
  says([this, heading, filament_heading] {
    filament_heading->setText(tr("Filament"));
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

/// Of machines whose probe has one.
QWidget* JogPage::make_pin(QWidget* parent) {
  using P = joblink::MoveProbePin;
  pin_ = new QWidget(parent);
  auto* grid = new QGridLayout(pin_);
  grid->setContentsMargins(0, 8, 0, 0);
  grid->setSpacing(8);
  pin_state_ = make_label("muted", pin_);
  grid->addWidget(pin_state_, 0, 0, 1, 2);
  const auto button = [&](int row, int column, P::Order order) {
    auto* made = make_button(desk_.theme, QStringLiteral("play"), "", pin_);
    connect(made, &QPushButton::clicked, &desk_.session,
            [this, order] { desk_.session.move_probe_pin(order); });
    grid->addWidget(made, row, column);
    pin_buttons_.push_back(made);
    return made;
  };
  auto* out = button(1, 0, P::OUT);
  auto* in = button(1, 1, P::IN);
  auto* test = button(2, 0, P::SELF_TEST);
  auto* reset = button(2, 1, P::RESET);
  says([=, this] {
    out->setText(tr("Pin out"));
    in->setText(tr("Pin in"));
    test->setText(tr("Self test"));
    test->setToolTip(tr("The pin goes out and in by itself, until it is told something else"));
    reset->setText(tr("End alarm"));
    reset->setToolTip(tr("The probe forgets its alarm, and the pin goes in"));
    show_pin();
  });
  return pin_;
}

void JogPage::show_pin() {
  const auto where = desk_.session.status().probe_pin();
  pin_->setVisible(where != joblink::PROBE_PIN_NONE);
  pin_state_->setText(where == joblink::PROBE_PIN_OUT     ? tr("The probe's pin is out")
                      : where == joblink::PROBE_PIN_IN    ? tr("The probe's pin is in")
                      : where == joblink::PROBE_PIN_MOVES ? tr("The probe's pin moves")
                      : where == joblink::PROBE_PIN_TESTS ? tr("The probe tests itself")
                                                          : tr("The probe's pin is not where it should be"));
  const bool can = desk_.session.allowed(joblink::COMMAND_MOVE_PROBE_PIN);
  for (QPushButton* button : pin_buttons_) {
    if (!can && button->hasFocus()) setFocus();
    set_usable(*button, can, desk_.session.why_not(joblink::COMMAND_MOVE_PROBE_PIN));
  }
}

QWidget* JogPage::make_offsets() {
  auto* card = new Card(this);
  auto* heading = make_label("heading", card);
  active_offset_ = make_label("small", card);
  wrap_words(*active_offset_);
  system_ = new QComboBox(card);
  for (const char* name : kSystems) system_->addItem(QString::fromLatin1(name));
  turn_with_focus_only(*system_);
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
    setAccessibleName(tr("Jog"));
    if (offsets_ != nullptr) arrange();  // words are wider in another language
    system_->setAccessibleName(tr("Coordinate system"));
    zero_here_->setText(tr("Zero here"));
    zero_here_->setToolTip(tr("The tool's position becomes the zero of this system"));
    set_offset_->setText(tr("Set"));
    set_offset_->setToolTip(tr("The values above become the zero of this system"));
    take_status();
  });
  return card;
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
  // Homing a machine that is off wakes it first.
  const bool wakes = s.state() == joblink::STATE_OFF && desk_.session.allowed(joblink::COMMAND_BRING_UP);
  enable(home_, joblink::COMMAND_HOME, wakes);
  enable(reference_, joblink::COMMAND_REFERENCE);
  enable(hold_, joblink::COMMAND_HOLD);
  enable(clear_, joblink::COMMAND_CLEAR);
  enable(motors_off_, joblink::COMMAND_MOTORS_OFF);
  show_pin();
  enable(zero_here_, joblink::COMMAND_JOG);
  enable(set_offset_, joblink::COMMAND_SET_WORK_OFFSET);
  const auto system = static_cast<std::size_t>(s.work_system());
  if (connected && system >= 1 && system <= kSystems.size()) {
    const joblink::Pose& o = s.work_offset();
    const auto mm = [](double v) { return Format::number(v, 3); };
    active_offset_->setText(
        tr("Active: %1, zero at %2")
            .arg(Format::isolated(QString::fromLatin1(kSystems[system - 1])),
                 Format::isolated(
                     QStringLiteral("X %1  Y %2  Z %3").arg(mm(o.x_mm()), mm(o.y_mm()), mm(o.z_mm())))));
  } else {
    active_offset_->setText(tr("Zeros of the work coordinates"));
  }
}

void JogPage::keyPressEvent(QKeyEvent* event) {
  if (!pad_->key(*event)) return SpeakingWidget::keyPressEvent(event);
  event->accept();
}

void JogPage::keyReleaseEvent(QKeyEvent* event) {
  if (!pad_->key(*event)) return SpeakingWidget::keyReleaseEvent(event);
  event->accept();
}

void JogPage::focusOutEvent(QFocusEvent* event) {
  pad_->let_go();
  SpeakingWidget::focusOutEvent(event);
}

}  // namespace kinebus::gui
