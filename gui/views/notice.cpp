#include "gui/views/notice.hpp"

#include <QHBoxLayout>
#include <QToolButton>
#include <algorithm>

namespace kinebus::gui {
namespace {
constexpr int kStays_ms = 15'000;
constexpr int kMargin = 12;
}  // namespace

Notice::Notice(const Theme& theme, QWidget* room) : SpeakingWidget(room), timer_(this) {
  setObjectName(QStringLiteral("banner"));
  setProperty("kind", "danger");
  setAttribute(Qt::WA_StyledBackground);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(14, 7, 8, 7);
  text_ = new QLabel(this);
  wrap_words(*text_);
  auto* close = make_tool(theme, QStringLiteral("cancel"), false, this);
  // What was told once is not told again in another language.
  says([this, close] {
    close->setAccessibleName(tr("Close"));
    close->setToolTip(close->accessibleName());
    if (!alarm_) go();
  });
  row->addWidget(text_, 1);
  row->addWidget(close);
  timer_.setSingleShot(true);
  timer_.setInterval(kStays_ms);
  connect(&timer_, &QTimer::timeout, this, &Notice::go);
  connect(close, &QToolButton::clicked, this, [this] {
    alarm_ = false;
    go();
  });
  room->installEventFilter(this);
  hide();
}

void Notice::tell(const QString& words) {
  if (alarm_ && isVisible()) {
    // The alarm is not hidden by what is refused because of it.
    const auto lines = text_->text().section(QLatin1Char('\n'), 0, 0);
    appear(lines + QLatin1Char('\n') + words);
    return;
  }
  appear(words);
  timer_.start();
}

void Notice::tell_alarm(const QString& words) {
  alarm_ = true;
  timer_.stop();
  appear(words);
}

void Notice::end_alarm() {
  if (!alarm_) return;
  alarm_ = false;
  go();
}

/// Its words were of then, and of the language then.
void Notice::go() {
  hide();
  text_->clear();
}

bool Notice::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && isVisible()) place();
  return SpeakingWidget::eventFilter(watched, event);
}

void Notice::appear(const QString& words) {
  text_->setText(words);
  place();
  show();
  raise();
}

void Notice::place() {
  const int width = std::max(1, parentWidget()->width() - 2 * kMargin);
  setGeometry(kMargin, 4, width, std::max(layout()->heightForWidth(width), layout()->sizeHint().height()));
}

}  // namespace kinebus::gui
