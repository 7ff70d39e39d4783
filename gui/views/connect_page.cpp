#include "gui/views/connect_page.hpp"

#include <QHBoxLayout>
#include <QIcon>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <QWidget>

namespace kinebus::gui {

ConnectPage::ConnectPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* body = new QWidget;
  auto* centred = new QHBoxLayout(body);
  auto* column = new QVBoxLayout;
  column->setSpacing(14);
  column->setContentsMargins(20, 26, 20, 20);
  auto* frame = new QWidget(body);
  frame->setMaximumWidth(620);
  frame->setLayout(column);
  centred->addStretch(1);
  centred->addWidget(frame, 8);
  centred->addStretch(1);

  column->addStretch(1);
  auto* head = new QHBoxLayout;
  auto* picture = new QLabel(frame);
  picture->setPixmap(QIcon(QStringLiteral(":/icons/kinebus.svg")).pixmap(64, 64));
  auto* words = new QVBoxLayout;
  words->setSpacing(2);
  title_ = make_label("title", frame);
  subtitle_ = make_label("muted", frame);
  wrap_words(*subtitle_);
  words->addWidget(title_);
  words->addWidget(subtitle_);
  head->addWidget(picture);
  head->addSpacing(12);
  head->addLayout(words, 1);
  column->addLayout(head);

  link_card_ = new Card(frame);
  auto* link_row = new QHBoxLayout;
  link_words_ = new QLabel(link_card_);
  wrap_words(*link_words_);
  leave_ = make_button(desk_.theme, QStringLiteral("cancel"), "", link_card_);
  link_row->addWidget(link_words_, 1);
  link_row->addWidget(leave_);
  link_card_->column()->addLayout(link_row);
  column->addWidget(link_card_);

  auto* found_card = new Card(frame);
  found_heading_ = make_label("heading", found_card);
  none_ = make_label("muted", found_card);
  wrap_words(*none_);
  found_ = new QVBoxLayout;
  found_->setSpacing(8);
  found_card->column()->addWidget(found_heading_);
  found_card->column()->addWidget(none_);
  found_card->column()->addLayout(found_);
  column->addWidget(found_card);

  // Words at the left, what they speak of at the right.
  const auto offer = [&](const QString& icon, const char* kind, QLabel*& heading, QLabel*& detail) {
    auto* card = new Card(frame);
    auto* row = new QHBoxLayout;
    auto* lines = new QVBoxLayout;
    heading = make_label("heading", card);
    detail = make_label("muted", card);
    wrap_words(*detail);
    lines->addWidget(heading);
    lines->addWidget(detail);
    QPushButton* button = make_button(desk_.theme, icon, kind, card);
    row->addLayout(lines, 1);
    row->addSpacing(12);
    row->addWidget(button);
    card->column()->addLayout(row);
    column->addWidget(card);
    return button;
  };
  demo_ = offer(QStringLiteral("demo"), "primary", demo_heading_, demo_words_);
  bench_ = offer(QStringLiteral("machine"), "", bench_heading_, bench_words_);
  problem_ = make_label("danger", frame);
  wrap_words(*problem_);
  problem_->hide();
  column->addWidget(problem_);
  column->addStretch(2);

  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(body);
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  outer->addWidget(scroll);

  connect(demo_, &QPushButton::clicked, this, &ConnectPage::start_demo);
  connect(bench_, &QPushButton::clicked, this, [this] { show_bench(); });
  connect(leave_, &QPushButton::clicked, this, [this] {
    desk_.session.disconnect_from_gateway();
    desk_.demo.reset();
  });
  connect(&desk_.finder, &GatewayFinder::changed, this, &ConnectPage::rebuild);
  connect(&desk_.session, &Session::link_changed, this, &ConnectPage::tell);
  says([this] {
    title_->setText(tr("Connect to a machine"));
    subtitle_->setText(
        tr("A gateway appears here as soon as its USB cable is plugged in or its daemon runs on this "
           "computer."));
    found_heading_->setText(tr("Gateways"));
    none_->setText(tr("None found yet."));
    demo_heading_->setText(tr("Demo machine"));
    demo_words_->setText(
        tr("The whole machine, simulated on this computer: upload, home and print without hardware."));
    demo_->setText(tr("Try the demo"));
    bench_heading_->setText(tr("A driver card on a bench"));
    bench_words_->setText(tr(
        "One node on this computer's CAN interface, without gateway and machine file: its motors' currents, "
        "jogged and measured, and its switches."));
    bench_->setText(tr("Open the card"));
    leave_->setText(tr("Disconnect"));
    rebuild();
    tell();
  });
}

void ConnectPage::start_demo() {
  problem_->hide();
  desk_.start_demo([self = QPointer<ConnectPage>(this)](const QString& why) {
    if (self.isNull()) return;
    self->problem_->setText(tr("The demo machine does not run: %1").arg(why));
    self->problem_->show();
  });
}

BenchWindow& ConnectPage::show_bench() {
  if (bench_window_ == nullptr) bench_window_ = new BenchWindow(desk_.theme, BenchCard::find_program(), this);
  bench_window_->show();
  bench_window_->raise();
  bench_window_->activateWindow();
  return *bench_window_;
}

void ConnectPage::rebuild() {
  for (QWidget* row : rows_) row->deleteLater();
  rows_.clear();
  for (const FoundGateway& gateway : desk_.finder.gateways()) {
    auto* row = new QWidget(this);
    auto* line = new QHBoxLayout(row);
    line->setContentsMargins(0, 2, 0, 2);
    auto* words = new QVBoxLayout;
    words->setSpacing(1);
    auto* title = new QLabel(gateway.title.said(), row);
    auto* detail = new ElidedLabel(row);
    detail->setProperty("role", "small");
    detail->set_text(gateway.detail.said());
    words->addWidget(title);
    words->addWidget(detail);
    auto* go = make_button(desk_.theme, QStringLiteral("gateway"), "", row);
    go->setText(tr("Connect"));
    go->setAccessibleName(tr("Connect to %1").arg(gateway.detail.said()));
    connect(go, &QPushButton::clicked, this, [this, gateway] { desk_.connect_to(gateway); });
    line->addLayout(words, 1);
    line->addWidget(go);
    found_->addWidget(row);
    rows_.push_back(row);
  }
  none_->setVisible(rows_.isEmpty());
}

void ConnectPage::tell() {
  const Session& session = desk_.session;
  link_card_->setVisible(session.link_state() != Session::LinkState::kNone);
  switch (session.link_state()) {
    case Session::LinkState::kNone:
      break;
    case Session::LinkState::kConnecting:
      link_words_->setText(
          session.link_words().isEmpty()
              ? tr("Connecting to %1…").arg(session.gateway_title())
              : tr("%1 does not answer: %2").arg(session.gateway_title(), session.link_words()));
      break;
    case Session::LinkState::kConnected:
      link_words_->setText(tr("Connected to %1.").arg(session.gateway_title()));
      break;
    case Session::LinkState::kLost:
      link_words_->setText(tr("The connection is lost: %1. It is tried again by itself. Jobs run on the "
                              "gateway: a pulled cable does not end them.")
                               .arg(session.link_words()));
      break;
  }
}

}  // namespace kinebus::gui
