#include "gui/views/top_bar.hpp"

#include <QAction>
#include <QActionGroup>
#include <QColor>
#include <QCoreApplication>
#include <QFont>
#include <QFontMetrics>
#include <QHBoxLayout>
#include <QIcon>
#include <QLabel>
#include <QPaintEvent>
#include <QPainter>
#include <QPen>
#include <QPointF>
#include <QPushButton>
#include <QRect>
#include <QRectF>
#include <QSize>
#include <QSizePolicy>
#include <QToolButton>
#include <QWidget>

#include "gui/models/format.hpp"

namespace kinebus::gui {

StateChip::StateChip(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
}

QFont StateChip::chip_font() const {
  QFont font = this->font();
  font.setPointSizeF(12);
  font.setWeight(QFont::DemiBold);
  return font;
}

void StateChip::set(const QString& words, const QColor& colour) {
  if (words == words_ && colour == colour_) return;
  words_ = words;
  colour_ = colour;
  setAccessibleName(words);
  updateGeometry();
  update();
}

QSize StateChip::sizeHint() const {
  return {QFontMetrics(chip_font()).horizontalAdvance(words_) + 48, 36};
}

void StateChip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  QColor ground = colour_;
  ground.setAlpha(36);
  painter.setPen(QPen(colour_, 1.2));
  painter.setBrush(ground);
  painter.drawRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), height() / 2.0 - 1, height() / 2.0 - 1);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour_);
  painter.drawEllipse(QPointF(mirrored ? width() - 19 : 19, height() / 2.0), 5, 5);
  painter.setFont(chip_font());
  painter.setPen(colour_);
  const QRect words = mirrored ? rect().adjusted(14, 0, -32, 0) : rect().adjusted(32, 0, -14, 0);
  painter.drawText(words, static_cast<int>(Qt::AlignVCenter | (mirrored ? Qt::AlignRight : Qt::AlignLeft)),
                   words_);
}

TopBar::TopBar(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  setObjectName(QStringLiteral("topBar"));
  setAttribute(Qt::WA_StyledBackground);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(16, 9, 12, 9);
  row->setSpacing(12);
  auto* picture = new QLabel(this);
  picture->setPixmap(QIcon(QStringLiteral(":/icons/kinebus.svg")).pixmap(30, 30));
  auto* brand = new QLabel(QStringLiteral("Kinebus"), this);
  brand->setObjectName(QStringLiteral("brand"));
  chip_ = new StateChip(this);
  doing_ = new ElidedLabel(this);
  doing_->setProperty("role", "muted");
  doing_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  control_ = make_button(desk_.theme, QStringLiteral("lock"), "", this);
  connection_ = make_tool(desk_.theme, QStringLiteral("gateway"), false, this);
  connection_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  language_ = make_tool(desk_.theme, QStringLiteral("language"), false, this);
  language_->setPopupMode(QToolButton::InstantPopup);
  languages_ = new QMenu(language_);
  auto* group = new QActionGroup(languages_);
  for (const auto& choice : Language::choices()) {
    QAction* action = languages_->addAction(choice.own_name);
    action->setCheckable(true);
    action->setData(choice.code);
    group->addAction(action);
    connect(action, &QAction::triggered, this, [this, code = choice.code] { emit language_chosen(code); });
  }
  language_->setMenu(languages_);
  theme_ = make_tool(desk_.theme, QStringLiteral("theme"), false, this);
  stop_ = new QPushButton(this);
  stop_->setObjectName(QStringLiteral("stopButton"));
  stop_->setIconSize({20, 20});
  stop_->setShortcut(Qt::CTRL | Qt::Key_Period);
  row->addWidget(picture);
  row->addWidget(brand);
  row->addSpacing(10);
  row->addWidget(chip_);
  row->addWidget(doing_, 1);
  row->addWidget(control_);
  row->addWidget(connection_);
  row->addWidget(theme_);
  row->addWidget(language_);
  row->addSpacing(4);
  row->addWidget(stop_);

  connect(stop_, &QPushButton::clicked, &desk_.session, &Session::stop);
  connect(theme_, &QToolButton::clicked, this, [this] { emit theme_chosen(!desk_.theme.dark()); });
  connect(connection_, &QToolButton::clicked, this, &TopBar::gateways_wanted);
  connect(control_, &QPushButton::clicked, this, [this] { desk_.session.take_control(true); });
  connect(&desk_.session, &Session::status_changed, this, &TopBar::take);
  connect(&desk_.session, &Session::link_changed, this, &TopBar::take);
  silence_.setInterval(1000);
  connect(&silence_, &QTimer::timeout, this, &TopBar::take);
  connect(&desk_.theme, &Theme::changed, this, [this] {
    colour_stop();
    take();
  });
  colour_stop();
  says([this] {
    stop_->setText(QStringLiteral(u"\u2002") + tr("STOP"));  // the sign stands apart from the word
    stop_->setToolTip(tr("Stops all motion at once, on the path (Ctrl+.)"));
    stop_->setShortcut(Qt::CTRL | Qt::Key_Period);  // a new text has taken it away
    language_->setToolTip(tr("Language"));
    language_->setAccessibleName(language_->toolTip());
    theme_->setToolTip(tr("Light or dark"));
    theme_->setAccessibleName(theme_->toolTip());
    control_->setText(tr("Take control"));
    for (QAction* action : languages_->actions())
      action->setChecked(action->data().toString() == desk_.language.code());
    take();
  });
}

void TopBar::colour_stop() {
  stop_->setIcon(desk_.theme.icon(QStringLiteral("stop"), desk_.theme.colours().danger_text));
}

void TopBar::take() {
  const Session& session = desk_.session;
  const joblink::Status& s = session.status();
  stop_->setEnabled(session.connected());
  control_->setVisible(session.others_have_control());
  if (session.others_have_control())
    for (const auto& client : s.clients())
      if (client.id() == s.controller())
        control_->setToolTip(tr("%1 has control").arg(QString::fromStdString(client.name())));
  QString doing;
  const auto silent = [&] { return Format::isolated(Format::duration(session.status_age_s())); };
  if (session.link_state() != Session::LinkState::kLost)
    silence_.stop();
  else if (!silence_.isActive())
    silence_.start();
  switch (session.link_state()) {
    case Session::LinkState::kNone:
      chip_->set(tr("Not connected"), desk_.theme.tone(StateTone::kNeutral));
      break;
    case Session::LinkState::kConnecting:
      chip_->set(tr("Connecting"), desk_.theme.tone(StateTone::kWaiting));
      break;
    case Session::LinkState::kLost:
      chip_->set(tr("Connection lost"), desk_.theme.tone(StateTone::kWaiting));
      doing =
          s.job().empty()
              ? tr("No news for %1. Last known: %2").arg(silent(), StateWords::title(s.state()))
              : tr("No news for %1. Last known: %2, %3 at %4")
                    .arg(silent(), StateWords::title(s.state()),
                         Format::isolated(QString::fromStdString(s.job())), Format::percent(s.progress(), 1));
      break;
    case Session::LinkState::kConnected:
      chip_->set(StateWords::title(s.state()), desk_.theme.tone(StateWords::tone(s.state())));
      if (!s.job().empty())
        doing = Format::isolated(QString::fromStdString(s.job())) + QStringLiteral(" · ") +
                Format::percent(s.progress(), 1);
      else
        doing = StateWords::next(s.state());
      break;
  }
  doing_->set_text(doing);
  connection_->setText(session.link_state() == Session::LinkState::kNone ? tr("Connect")
                       : desk_.demo != nullptr ? QCoreApplication::translate("Desk", "Demo machine")
                                               : session.gateway_title());
  connection_->setToolTip(
      session.connected()
          ? tr("%1 · %2").arg(QString::fromStdString(session.machine().name()), session.link_words())
          : tr("Choose a gateway"));
}

}  // namespace kinebus::gui
