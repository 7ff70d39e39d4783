#include "gui/views/main_window.hpp"

#include <QAbstractButton>
#include <QButtonGroup>
#include <QCloseEvent>
#include <QDockWidget>
#include <QEvent>
#include <QHBoxLayout>
#include <QIcon>
#include <QKeySequence>
#include <QLatin1String>
#include <QLocale>
#include <QMessageBox>
#include <QModelIndex>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QSizePolicy>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>

#include "gui/session/gateway_words.hpp"
#include "gui/views/alarms_page.hpp"
#include "gui/views/connect_page.hpp"
#include "gui/views/console_page.hpp"
#include "gui/views/job_panel.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/jog_page.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/notice.hpp"
#include "gui/views/position_panel.hpp"
#include "gui/views/top_bar.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {
constexpr int kLayoutVersion = 1;
constexpr std::array<const char*, MainWindow::kPages> kIcons{"gateway", "view",   "jobs",   "jog",
                                                             "console", "alarms", "machine"};
}  // namespace

MainWindow::MainWindow(Desk& desk) : desk_(desk) {
  setWindowIcon(QIcon(QStringLiteral(":/icons/kinebus.svg")));
  setWindowTitle(QStringLiteral("Kinebus"));
  setMinimumSize(980, 600);
  setDockNestingEnabled(true);

  top_ = new TopBar(desk_, this);
  pages_ = new QStackedWidget(this);
  connect_ = new ConnectPage(desk_, pages_);
  view_ = new ViewPage(desk_, pages_);
  jobs_ = new JobsPage(desk_, pages_);
  jog_ = new JogPage(desk_, pages_);
  console_ = new ConsolePage(desk_, pages_);
  alarms_ = new AlarmsPage(desk_, pages_);
  machine_ = new MachinePage(desk_, pages_);
  for (QWidget* page :
       {static_cast<QWidget*>(connect_), static_cast<QWidget*>(view_), static_cast<QWidget*>(jobs_),
        static_cast<QWidget*>(jog_), static_cast<QWidget*>(console_), static_cast<QWidget*>(alarms_),
        static_cast<QWidget*>(machine_)})
    pages_->addWidget(page);

  auto* centre = new QWidget(this);
  auto* side = new QHBoxLayout(centre);
  side->setContentsMargins(0, 0, 0, 0);
  side->setSpacing(0);
  side->addWidget(make_navigation());
  side->addWidget(pages_, 1);
  setCentralWidget(centre);
  notice_ = new Notice(desk_.theme, pages_);
  setMenuWidget(top_);

  position_dock_ = make_dock(QStringLiteral("position"), new PositionPanel(desk_));
  job_dock_ = make_dock(QStringLiteral("job"), new JobPanel(desk_));
  addDockWidget(Qt::RightDockWidgetArea, job_dock_);
  addDockWidget(Qt::RightDockWidgetArea, position_dock_);

  connect(top_, &TopBar::theme_chosen, this, &MainWindow::set_theme);
  connect(top_, &TopBar::language_chosen, this, &MainWindow::set_language);
  connect(top_, &TopBar::gateways_wanted, this, [this] { show_page(kConnect); });
  connect(jobs_, &JobsPage::show_place, view_, &ViewPage::show_line);
  connect(jobs_, &JobsPage::show_view, this, [this] { show_page(kView); });
  connect(&desk_.session, &Session::link_changed, this, &MainWindow::take_link);
  connect(&desk_.session, &Session::refused, notice_, &Notice::tell);
  connect(&desk_.events, &EventsModel::open_alarms_changed, this, &MainWindow::retranslate);
  connect(&desk_.events, &EventsModel::open_alarms_changed, this, [this] {
    if (desk_.events.open_alarms() == 0) notice_->end_alarm();
  });
  connect(&desk_.events, &EventsModel::alarm_arrived, this, &MainWindow::tell_alarm);
  // What does not begin or go on says why, and what to do.
  connect(&desk_.session, &Session::event_arrived, this, [this](const joblink::Event& event) {
    if (event.kind() != joblink::EVENT_FINISHED || event.advice().empty()) return;
    notice_->tell(GatewayWords::said(event.said(), event.words()) + QStringLiteral(" — ") +
                  GatewayWords::said(event.advice_said(), event.advice()));
  });
  for (int i = 0; i < kPages; ++i) {
    auto* shortcut = new QShortcut(QKeySequence(Qt::CTRL | static_cast<Qt::Key>(Qt::Key_1 + i)), this);
    connect(shortcut, &QShortcut::activated, this, [this, i] { show_page(static_cast<Page>(i)); });
  }
  mirror_docks();
  retranslate();
  take_link();
  show_page(kConnect);
  resize(1280, 720);
}

QWidget* MainWindow::make_navigation() {
  auto* bar = new QWidget(this);
  bar->setObjectName(QStringLiteral("navigation"));
  bar->setAttribute(Qt::WA_StyledBackground);
  bar->setFixedWidth(96);
  auto* column = new QVBoxLayout(bar);
  column->setContentsMargins(0, 8, 0, 8);
  column->setSpacing(1);
  navigation_ = new QButtonGroup(bar);
  for (int i = 0; i < kPages; ++i) {
    QToolButton* button =
        make_tool(desk_.theme, QString::fromLatin1(kIcons[static_cast<std::size_t>(i)]), true, bar);
    button->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    button->setIconSize({23, 23});
    navigation_->addButton(button, i);
    column->addWidget(button);
  }
  column->addStretch(1);
  connect(navigation_, &QButtonGroup::idClicked, this,
          [this](int page) { show_page(static_cast<Page>(page)); });
  // A screen reader toggles the button, which is no click.
  connect(navigation_, &QButtonGroup::idToggled, this, [this](int number, bool on) {
    if (on && number != page()) show_page(static_cast<Page>(number));
  });
  return bar;
}

QDockWidget* MainWindow::make_dock(const QString& name, QWidget* content) {
  auto* dock = new QDockWidget(this);
  dock->setObjectName(name);
  dock->setFeatures(QDockWidget::DockWidgetMovable | QDockWidget::DockWidgetFloatable);
  dock->setAllowedAreas(Qt::LeftDockWidgetArea | Qt::RightDockWidgetArea);
  auto* scroll = new QScrollArea(dock);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFocusPolicy(Qt::NoFocus);
  scroll->setWidget(content);
  scroll->setMinimumWidth(content->minimumWidth() + 26);
  // The job is whole; what is left belongs to the position.
  if (name == QLatin1String("job")) scroll->setMinimumHeight(content->sizeHint().height() + 34);
  dock->setWidget(scroll);
  return dock;
}

void MainWindow::retranslate() {
  const std::array<QString, kPages> names{tr("Gateways"), tr("View"),   tr("Jobs"),   tr("Jog"),
                                          tr("Console"),  tr("Alarms"), tr("Machine")};
  for (int i = 0; i < kPages; ++i) {
    QAbstractButton* button = navigation_->button(i);
    QString name = names[static_cast<std::size_t>(i)];
    if (i == kAlarms && desk_.events.open_alarms() > 0)
      name += QStringLiteral(" (%1)").arg(QLocale().toString(desk_.events.open_alarms()));
    button->setText(name);
    button->setToolTip(QStringLiteral("%1 (Ctrl+%2)").arg(names[static_cast<std::size_t>(i)]).arg(i + 1));
  }
  position_dock_->setWindowTitle(tr("Position"));
  job_dock_->setWindowTitle(tr("Job"));
}

void MainWindow::tell_alarm() {
  for (int row = 0; row < desk_.events.rowCount(); ++row) {
    const QModelIndex newest = desk_.events.index(row);
    if (!newest.data(EventsModel::kIsAlarm).toBool()) continue;
    return notice_->tell_alarm(newest.data(EventsModel::kTitle).toString() + QStringLiteral(" — ") +
                               newest.data(EventsModel::kAdvice).toString());
  }
}

void MainWindow::mirror_docks() {
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  if (mirrored == docks_mirrored_) return;
  docks_mirrored_ = mirrored;
  for (QDockWidget* dock : {job_dock_, position_dock_}) {
    if (dock->isFloating()) continue;
    const bool hidden = dock->isHidden();
    addDockWidget(
        dockWidgetArea(dock) == Qt::LeftDockWidgetArea ? Qt::RightDockWidgetArea : Qt::LeftDockWidgetArea,
        dock);
    dock->setVisible(!hidden);
  }
}

void MainWindow::changeEvent(QEvent* event) {
  if (event->type() == QEvent::LanguageChange) {
    retranslate();
    if (notice_->of_alarm()) tell_alarm();
  }
  if (event->type() == QEvent::LayoutDirectionChange) mirror_docks();
  QMainWindow::changeEvent(event);
}

MainWindow::Page MainWindow::page() const {
  return static_cast<Page>(pages_->currentIndex());
}

void MainWindow::show_page(Page page) {
  pages_->setCurrentIndex(page);
  navigation_->button(page)->setChecked(true);
  if (page == kJog || page == kConsole) pages_->currentWidget()->setFocus();
  if (page == kView) view_->scene().setFocus();
  if (page == kView) view_->scene().redraw();
}

void MainWindow::take_link() {
  const bool connected = desk_.session.connected();
  const bool none = desk_.session.link_state() == Session::LinkState::kNone;
  for (int i = kView; i < kPages; ++i) navigation_->button(i)->setEnabled(true);
  position_dock_->setVisible(!none);
  job_dock_->setVisible(!none);
  if (connected && !was_connected_ && page() == kConnect) show_page(kView);
  if (none) {
    desk_.path.clear();
    show_page(kConnect);
  }
  was_connected_ = connected;
}

void MainWindow::set_theme(bool dark) {
  desk_.theme.apply(dark);
}

void MainWindow::set_language(const QString& code) {
  desk_.language.apply(code);
}

void MainWindow::save(QSettings& settings) const {
  settings.setValue(QStringLiteral("window/geometry"), saveGeometry());
  if (!position_dock_->isHidden())
    settings.setValue(QStringLiteral("window/layout"), saveState(kLayoutVersion));
  settings.setValue(QStringLiteral("window/mirrored"), docks_mirrored_);
  settings.setValue(QStringLiteral("window/page"), static_cast<int>(page()));
  settings.setValue(QStringLiteral("theme/dark"), desk_.theme.dark());
  settings.setValue(QStringLiteral("language"), desk_.language.code());
  settings.setValue(QStringLiteral("console/history"), console_->history());
  view_->save(settings);
}

void MainWindow::restore(QSettings& settings) {
  restoreGeometry(settings.value(QStringLiteral("window/geometry")).toByteArray());
  const bool shown = !position_dock_->isHidden();
  restoreState(settings.value(QStringLiteral("window/layout")).toByteArray(), kLayoutVersion);
  position_dock_->setVisible(shown);
  job_dock_->setVisible(shown);
  // The layout may be one of another language.
  if (settings.contains(QStringLiteral("window/layout")))
    docks_mirrored_ = settings.value(QStringLiteral("window/mirrored")).toBool();
  mirror_docks();
  console_->set_history(settings.value(QStringLiteral("console/history")).toStringList());
  view_->restore(settings);
}

void MainWindow::ask_before_the_demo_ends() {
  auto* question = new QMessageBox(QMessageBox::Question, tr("Close the demo"),
                                   tr("The demo machine ends with this window, and its job with it."),
                                   QMessageBox::NoButton, this);
  question->setAttribute(Qt::WA_DeleteOnClose);
  auto* yes = question->addButton(tr("Close"), QMessageBox::DestructiveRole);
  auto* no = question->addButton(tr("Go on"), QMessageBox::RejectRole);
  question->setDefaultButton(no);
  question->setEscapeButton(no);
  connect(yes, &QAbstractButton::clicked, this, [this] {
    end_of_demo_is_wanted_ = true;
    close();
  });
  question->open();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (desk_.demo != nullptr && desk_.session.connected() && !desk_.session.status().job().empty() &&
      !end_of_demo_is_wanted_) {
    event->ignore();
    ask_before_the_demo_ends();
    return;
  }
  QSettings settings;
  save(settings);
  event->accept();
}

}  // namespace kinebus::gui
