<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="fa" sourcelanguage="en">
    <context>
        <name>AlarmWords</name>
        <message>
            <source>A node does not answer</source>
            <translation>یک گره پاسخ نمی‌دهد</translation>
        </message>
        <message>
            <source>The wrong node is connected</source>
            <translation>گرهٔ نادرست وصل است</translation>
        </message>
        <message>
            <source>A node refuses its settings</source>
            <translation>یک گره تنظیماتش را نمی‌پذیرد</translation>
        </message>
        <message>
            <source>A drive does not switch on</source>
            <translation>یک درایو روشن نمی‌شود</translation>
        </message>
        <message>
            <source>There is a second gateway on the bus</source>
            <translation>درگاه دومی روی گذرگاه است</translation>
        </message>
        <message>
            <source>A node has gone silent</source>
            <translation>یک گره ساکت شده است</translation>
        </message>
        <message>
            <source>A node has restarted</source>
            <translation>یک گره دوباره راه افتاده است</translation>
        </message>
        <message>
            <source>The clocks have drifted apart</source>
            <translation>ساعت‌ها از هم دور شده‌اند</translation>
        </message>
        <message>
            <source>Homing has failed</source>
            <translation>خانه‌یابی ناموفق بود</translation>
        </message>
        <message>
            <source>The carriages are too far apart</source>
            <translation>حامل‌ها بیش از حد از هم دورند</translation>
        </message>
        <message>
            <source>Homing took too long</source>
            <translation>خانه‌یابی بیش از حد طول کشید</translation>
        </message>
        <message>
            <source>Motion was interrupted</source>
            <translation>حرکت قطع شد</translation>
        </message>
        <message>
            <source>The nodes disagree about the path</source>
            <translation>گره‌ها دربارهٔ مسیر هم‌نظر نیستند</translation>
        </message>
        <message>
            <source>The bus has failed</source>
            <translation>گذرگاه از کار افتاده است</translation>
        </message>
        <message>
            <source>A heater is not as it should be</source>
            <translation>وضعیت یک گرم‌کن درست نیست</translation>
        </message>
        <message>
            <source>The job went wrong</source>
            <translation>کار با خطا روبه‌رو شد</translation>
        </message>
        <message>
            <source>Stopped by the operator</source>
            <translation>به دست کاربر متوقف شد</translation>
        </message>
        <message>
            <source>The machine did not come to rest</source>
            <translation>ماشین از حرکت نایستاد</translation>
        </message>
        <message>
            <source>Two nodes use the same id</source>
            <translation>دو گره یک شناسهٔ یکسان دارند</translation>
        </message>
        <message>
            <source>Too much current in a motor</source>
            <translation>جریان یک موتور بیش از حد است</translation>
        </message>
        <message>
            <source>The supply voltage is wrong</source>
            <translation>ولتاژ تغذیه نادرست است</translation>
        </message>
        <message>
            <source>A drive is too hot</source>
            <translation>یک درایو بیش از حد داغ است</translation>
        </message>
        <message>
            <source>Communication trouble on the bus</source>
            <translation>اشکال ارتباط روی گذرگاه</translation>
        </message>
        <message>
            <source>A carriage is not where it should be</source>
            <translation>یک حامل در جای خود نیست</translation>
        </message>
        <message>
            <source>Message</source>
            <translation>پیام</translation>
        </message>
        <message>
            <source>A node reports a fault</source>
            <translation>یک گره خطا گزارش می‌کند</translation>
        </message>
        <message>
            <source>Check the node's power and the bus cable, then home again.</source>
            <translation>برق گره و کابل گذرگاه را بررسی کنید، سپس دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Connect the right node or update its firmware.</source>
            <translation>گرهٔ درست را وصل کنید یا میان‌افزارش را به‌روز کنید.</translation>
        </message>
        <message>
            <source>Check the machine file against the node's limits.</source>
            <translation>پروندهٔ ماشین را با محدوده‌های گره مقایسه کنید.</translation>
        </message>
        <message>
            <source>Look at the drive's fault, clear the alarm, then home again.</source>
            <translation>خطای درایو را ببینید، هشدار را پاک کنید، سپس دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Switch one of the gateways off.</source>
            <translation>یکی از درگاه‌ها را خاموش کنید.</translation>
        </message>
        <message>
            <source>Check the node's power and the bus cable, then clear and home again.</source>
            <translation>برق گره و کابل گذرگاه را بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Check the node's power, then clear and home again.</source>
            <translation>برق گره را بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Check the bus for errors, then clear.</source>
            <translation>خطاهای گذرگاه را بررسی کنید، سپس پاک کنید.</translation>
        </message>
        <message>
            <source>Check the switch and its wiring, then clear and home again.</source>
            <translation>کلید و سیم‌کشی آن را بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Check the switches of the carriages that went on, then clear and home again.</source>
            <translation>کلیدهای حامل‌هایی را که پیش رفتند بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Check the switches and the homing speeds, then clear and home again.</source>
            <translation>کلیدها و سرعت‌های خانه‌یابی را بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Clear: positions are known, the job can be run again.</source>
            <translation>پاک کنید: موقعیت‌ها معلوم است و کار را می‌توان دوباره اجرا کرد.</translation>
        </message>
        <message>
            <source>Clear. If it comes again, check the bus for lost frames.</source>
            <translation>پاک کنید. اگر تکرار شد، قاب‌های گم‌شدهٔ گذرگاه را بررسی کنید.</translation>
        </message>
        <message>
            <source>Check cable and termination of the bus, then clear and home again.</source>
            <translation>کابل و پایانهٔ گذرگاه را بررسی کنید، سپس پاک کنید و دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Check the heater and its sensor, then clear.</source>
            <translation>گرم‌کن و حسگرش را بررسی کنید، سپس پاک کنید.</translation>
        </message>
        <message>
            <source>Correct the job, then clear.</source>
            <translation>کار را اصلاح کنید، سپس پاک کنید.</translation>
        </message>
        <message>
            <source>Clear when the machine is safe.</source>
            <translation>وقتی ماشین امن است پاک کنید.</translation>
        </message>
        <message>
            <source>Switch the machine off and on, then home again.</source>
            <translation>ماشین را خاموش و روشن کنید، سپس دوباره خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Give one of them another id or take it off the bus, then home again.</source>
            <translation>به یکی از آن‌ها شناسهٔ دیگری بدهید یا آن را از گذرگاه جدا کنید، سپس دوباره خانه‌یابی کنید.</translation>
        </message>
    </context>
    <context>
        <name>ConsoleHints</name>
        <message>
            <source>traverse</source>
            <translation>جابه‌جایی سریع</translation>
        </message>
        <message>
            <source>straight line at feed</source>
            <translation>خط راست با سرعت پیشروی</translation>
        </message>
        <message>
            <source>arc, clockwise</source>
            <translation>کمان، ساعت‌گرد</translation>
        </message>
        <message>
            <source>arc, counter-clockwise</source>
            <translation>کمان، پادساعت‌گرد</translation>
        </message>
        <message>
            <source>home, or go to the bed reference</source>
            <translation>خانه‌یابی یا رفتن به مرجع بستر</translation>
        </message>
        <message>
            <source>first work coordinate system</source>
            <translation>دستگاه مختصات کاری نخست</translation>
        </message>
        <message>
            <source>second work coordinate system</source>
            <translation>دستگاه مختصات کاری دوم</translation>
        </message>
        <message>
            <source>absolute positions</source>
            <translation>موقعیت‌های مطلق</translation>
        </message>
        <message>
            <source>relative positions</source>
            <translation>موقعیت‌های نسبی</translation>
        </message>
        <message>
            <source>call this position so</source>
            <translation>نام‌گذاری موقعیت کنونی</translation>
        </message>
        <message>
            <source>motors on</source>
            <translation>موتورها روشن</translation>
        </message>
        <message>
            <source>motors off</source>
            <translation>موتورها خاموش</translation>
        </message>
        <message>
            <source>list the jobs</source>
            <translation>فهرست کارها</translation>
        </message>
        <message>
            <source>choose a job</source>
            <translation>انتخاب کار</translation>
        </message>
        <message>
            <source>start or resume</source>
            <translation>آغاز یا ادامه</translation>
        </message>
        <message>
            <source>pause</source>
            <translation>مکث</translation>
        </message>
        <message>
            <source>progress of the job</source>
            <translation>پیشرفت کار</translation>
        </message>
        <message>
            <source>time of the job</source>
            <translation>زمان کار</translation>
        </message>
        <message>
            <source>extruder absolute</source>
            <translation>اکسترودر مطلق</translation>
        </message>
        <message>
            <source>extruder relative</source>
            <translation>اکسترودر نسبی</translation>
        </message>
        <message>
            <source>heat the nozzle</source>
            <translation>گرم کردن نازل</translation>
        </message>
        <message>
            <source>temperatures</source>
            <translation>دماها</translation>
        </message>
        <message>
            <source>fan on</source>
            <translation>فن روشن</translation>
        </message>
        <message>
            <source>fan off</source>
            <translation>فن خاموش</translation>
        </message>
        <message>
            <source>heat the nozzle and wait</source>
            <translation>گرم کردن نازل و انتظار</translation>
        </message>
        <message>
            <source>emergency stop</source>
            <translation>توقف اضطراری</translation>
        </message>
        <message>
            <source>position</source>
            <translation>موقعیت</translation>
        </message>
        <message>
            <source>name and capabilities</source>
            <translation>نام و توانایی‌ها</translation>
        </message>
        <message>
            <source>switches</source>
            <translation>کلیدها</translation>
        </message>
        <message>
            <source>heat the bed</source>
            <translation>گرم کردن بستر</translation>
        </message>
    </context>
    <context>
        <name>Desk</name>
        <message>
            <source>Demo machine</source>
            <translation>ماشین نمایشی</translation>
        </message>
    </context>
    <context>
        <name>Format</name>
        <message>
            <source>%1 B</source>
            <translation>%1 B</translation>
        </message>
        <message>
            <source>%1 kB</source>
            <translation>%1 kB</translation>
        </message>
        <message>
            <source>%1 MB</source>
            <translation>%1 MB</translation>
        </message>
        <message>
            <source>%1 GB</source>
            <translation>%1 GB</translation>
        </message>
        <message>
            <source>%1/s</source>
            <translation>%1/s</translation>
        </message>
        <message>
            <source>%1 °C</source>
            <translation>%1 °C</translation>
        </message>
    </context>
    <context>
        <name>StateWords</name>
        <message>
            <source>Motors off</source>
            <translation>موتورها خاموش</translation>
        </message>
        <message>
            <source>Waking the nodes</source>
            <translation>بیدار کردن گره‌ها</translation>
        </message>
        <message>
            <source>Not homed</source>
            <translation>خانه‌یابی نشده</translation>
        </message>
        <message>
            <source>Homing</source>
            <translation>خانه‌یابی</translation>
        </message>
        <message>
            <source>Ready</source>
            <translation>آماده</translation>
        </message>
        <message>
            <source>Moving</source>
            <translation>در حرکت</translation>
        </message>
        <message>
            <source>Checking the job</source>
            <translation>بررسی کار</translation>
        </message>
        <message>
            <source>Printing</source>
            <translation>در حال چاپ</translation>
        </message>
        <message>
            <source>Pausing</source>
            <translation>در حال مکث</translation>
        </message>
        <message>
            <source>Paused</source>
            <translation>مکث</translation>
        </message>
        <message>
            <source>Cancelling</source>
            <translation>در حال لغو</translation>
        </message>
        <message>
            <source>Stopping</source>
            <translation>در حال توقف</translation>
        </message>
        <message>
            <source>Stopped</source>
            <translation>متوقف</translation>
        </message>
        <message>
            <source>Alarm</source>
            <translation>هشدار</translation>
        </message>
        <message>
            <source>Unknown</source>
            <translation>نامعلوم</translation>
        </message>
        <message>
            <source>Home the machine to wake the motors and find the carriages.</source>
            <translation>برای بیدار کردن موتورها و یافتن حامل‌ها، ماشین را خانه‌یابی کنید.</translation>
        </message>
        <message>
            <source>Home the machine: positions are not known yet.</source>
            <translation>ماشین را خانه‌یابی کنید: موقعیت‌ها هنوز معلوم نیستند.</translation>
        </message>
        <message>
            <source>Choose a job and start it, or jog the tool.</source>
            <translation>کاری را برگزینید و آغاز کنید، یا ابزار را دستی حرکت دهید.</translation>
        </message>
        <message>
            <source>All carriages rest on the path. Resume or cancel.</source>
            <translation>همهٔ حامل‌ها روی مسیر ایستاده‌اند. ادامه دهید یا لغو کنید.</translation>
        </message>
        <message>
            <source>Make sure that the machine is safe, then clear the stop.</source>
            <translation>از امن بودن ماشین مطمئن شوید، سپس توقف را رفع کنید.</translation>
        </message>
        <message>
            <source>Read the alarm, remove its cause, then clear it.</source>
            <translation>هشدار را بخوانید، علت را برطرف کنید، سپس پاکش کنید.</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::AlarmsPage</name>
        <message>
            <source>Clear</source>
            <translation>پاک کردن</translation>
        </message>
        <message>
            <source>No alarm is open.</source>
            <translation>هیچ هشدار بازی نیست.</translation>
        </message>
        <message>
            <source>What has happened, newest first</source>
            <translation>رویدادها، تازه‌ترین در آغاز</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::AxesModel</name>
        <message>
            <source>Axis</source>
            <translation>محور</translation>
        </message>
        <message>
            <source>Position</source>
            <translation>موقعیت</translation>
        </message>
        <message>
            <source>Measured</source>
            <translation>اندازه‌گیری</translation>
        </message>
        <message>
            <source>Error</source>
            <translation>خطا</translation>
        </message>
        <message>
            <source>%1 µm</source>
            <translation>%1 µm</translation>
        </message>
        <message>
            <source>Travel</source>
            <translation>کورس</translation>
        </message>
        <message>
            <source>Current</source>
            <translation>جریان</translation>
        </message>
        <message>
            <source>Drive</source>
            <translation>درایو</translation>
        </message>
        <message>
            <source>Switch</source>
            <translation>کلید</translation>
        </message>
        <message>
            <source>Node</source>
            <translation>گره</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
        <message>
            <source>%1 A</source>
            <translation>%1 A</translation>
        </message>
        <message>
            <source>Fault</source>
            <translation>خطا</translation>
        </message>
        <message>
            <source>On</source>
            <translation>روشن</translation>
        </message>
        <message>
            <source>Off</source>
            <translation>خاموش</translation>
        </message>
        <message>
            <source>Hit</source>
            <translation>فعال</translation>
        </message>
        <message>
            <source>Free</source>
            <translation>آزاد</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ConnectPage</name>
        <message>
            <source>Connect to a machine</source>
            <translation>به یک ماشین وصل شوید</translation>
        </message>
        <message>
            <source>A gateway appears here as soon as its USB cable is plugged in or its daemon runs on this computer.</source>
            <translation>همین که کابل USB درگاه وصل شود یا سرویس آن روی این رایانه اجرا شود، درگاه اینجا دیده می‌شود.</translation>
        </message>
        <message>
            <source>Gateways</source>
            <translation>درگاه‌ها</translation>
        </message>
        <message>
            <source>None found yet.</source>
            <translation>هنوز چیزی پیدا نشده است.</translation>
        </message>
        <message>
            <source>Demo machine</source>
            <translation>ماشین نمایشی</translation>
        </message>
        <message>
            <source>The whole machine, simulated on this computer: upload, home and print without hardware.</source>
            <translation>کل ماشین، شبیه‌سازی‌شده روی این رایانه: بدون سخت‌افزار بفرستید، خانه‌یابی و چاپ کنید.</translation>
        </message>
        <message>
            <source>Try the demo</source>
            <translation>اجرای نمایشی</translation>
        </message>
        <message>
            <source>Disconnect</source>
            <translation>قطع اتصال</translation>
        </message>
        <message>
            <source>The demo machine does not run: %1</source>
            <translation>ماشین نمایشی اجرا نمی‌شود: %1</translation>
        </message>
        <message>
            <source>Connect</source>
            <translation>اتصال</translation>
        </message>
        <message>
            <source>Connect to %1</source>
            <translation>اتصال به %1</translation>
        </message>
        <message>
            <source>Connecting to %1…</source>
            <translation>در حال اتصال به %1…</translation>
        </message>
        <message>
            <source>%1 does not answer: %2</source>
            <translation>%1 پاسخ نمی‌دهد: %2</translation>
        </message>
        <message>
            <source>Connected to %1.</source>
            <translation>به %1 وصل است.</translation>
        </message>
        <message>
            <source>The connection is lost: %1. It comes back by itself; a job on the machine goes on.</source>
            <translation>اتصال قطع شد: %1. خودش برمی‌گردد و کار روی ماشین ادامه دارد.</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ConsolePage</name>
        <message>
            <source>Send</source>
            <translation>فرستادن</translation>
        </message>
        <message>
            <source>Answers of the gateway</source>
            <translation>پاسخ‌های درگاه</translation>
        </message>
        <message>
            <source>Lines you send and the gateway's answers appear here.</source>
            <translation>خط‌هایی که می‌فرستید و پاسخ‌های درگاه اینجا دیده می‌شوند.</translation>
        </message>
        <message>
            <source>G-code or M-code, for example M114</source>
            <translation>G-code یا M-code، برای نمونه M114</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::DemoGateway</name>
        <message>
            <source>the demo machine has ended</source>
            <translation>ماشین نمایشی پایان یافت</translation>
        </message>
        <message>
            <source>the program kinebusd was not found: install the package kinebus-daemon</source>
            <translation>برنامهٔ kinebusd پیدا نشد: بستهٔ kinebus-daemon را نصب کنید</translation>
        </message>
        <message>
            <source>the demo machine does not answer</source>
            <translation>ماشین نمایشی پاسخ نمی‌دهد</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::EventsModel</name>
        <message>
            <source>Done</source>
            <translation>انجام شد</translation>
        </message>
        <message>
            <source>The check of the job found a problem</source>
            <translation>بررسی کار اشکالی یافت</translation>
        </message>
        <message>
            <source>Control has moved to another program</source>
            <translation>کنترل به برنامهٔ دیگری رفت</translation>
        </message>
        <message>
            <source>Message</source>
            <translation>پیام</translation>
        </message>
        <message>
            <source>node %1</source>
            <translation>گره %1</translation>
        </message>
        <message>
            <source>line %1</source>
            <translation>خط %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::GatewayFinder</name>
        <message>
            <source>USB %1 · serial number %2</source>
            <translation>USB %1 · شمارهٔ سریال %2</translation>
        </message>
        <message>
            <source>Gateway on this computer</source>
            <translation>درگاه روی این رایانه</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobPanel</name>
        <message>
            <source>Interrupted: resume goes on from its place.</source>
            <translation>نیمه‌کاره: ادامه، از همان جا پی می‌گیرد.</translation>
        </message>
        <message>
            <source>Progress</source>
            <translation>پیشرفت</translation>
        </message>
        <message>
            <source>Elapsed</source>
            <translation>گذشته</translation>
        </message>
        <message>
            <source>Remaining</source>
            <translation>مانده</translation>
        </message>
        <message>
            <source>Line</source>
            <translation>خط</translation>
        </message>
        <message>
            <source>Cancel the job</source>
            <translation>لغو کار</translation>
        </message>
        <message>
            <source>Cancel the job? What is printed stays on the bed.</source>
            <translation>کار لغو شود؟ آنچه چاپ شده روی بستر می‌ماند.</translation>
        </message>
        <message>
            <source>Go on</source>
            <translation>ادامه</translation>
        </message>
        <message>
            <source>Speed</source>
            <translation>سرعت</translation>
        </message>
        <message>
            <source>Feed override in percent</source>
            <translation>ضریب سرعت به درصد</translation>
        </message>
        <message>
            <source>Pause</source>
            <translation>مکث</translation>
        </message>
        <message>
            <source>Resume</source>
            <translation>ادامه</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>لغو</translation>
        </message>
        <message>
            <source>No job is running</source>
            <translation>کاری در حال اجرا نیست</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobUpload</name>
        <message>
            <source>%1 cannot be read</source>
            <translation>%1 خوانده نمی‌شود</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobsModel</name>
        <message>
            <source>Job</source>
            <translation>کار</translation>
        </message>
        <message>
            <source>Size</source>
            <translation>اندازه</translation>
        </message>
        <message>
            <source>Uploaded</source>
            <translation>زمان ارسال</translation>
        </message>
        <message>
            <source>Check</source>
            <translation>بررسی</translation>
        </message>
        <message>
            <source>Time</source>
            <translation>زمان</translation>
        </message>
        <message>
            <source>Last run</source>
            <translation>آخرین اجرا</translation>
        </message>
        <message>
            <source>Reading</source>
            <translation>در حال خواندن</translation>
        </message>
        <message>
            <source>Waiting for the gateway</source>
            <translation>در انتظار درگاه</translation>
        </message>
        <message>
            <source>Failed</source>
            <translation>ناموفق</translation>
        </message>
        <message>
            <source>Not checked</source>
            <translation>بررسی نشده</translation>
        </message>
        <message numerus="yes">
            <source>%Ln error(s)</source>
            <translation>
                <numerusform>%Ln خطا</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%Ln warning(s)</source>
            <translation>
                <numerusform>%Ln اخطار</numerusform>
            </translation>
        </message>
        <message>
            <source>Fine</source>
            <translation>بی‌اشکال</translation>
        </message>
        <message>
            <source>Never</source>
            <translation>هرگز</translation>
        </message>
        <message>
            <source>Running</source>
            <translation>در حال اجرا</translation>
        </message>
        <message>
            <source>Complete, %1</source>
            <translation>کامل، %1</translation>
        </message>
        <message>
            <source>Cancelled</source>
            <translation>لغو شد</translation>
        </message>
        <message>
            <source>Refused by the check</source>
            <translation>در بررسی رد شد</translation>
        </message>
        <message>
            <source>Stopped by an alarm</source>
            <translation>با هشدار ایستاد</translation>
        </message>
        <message>
            <source>Interrupted</source>
            <translation>نیمه‌کاره</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobsPage</name>
        <message>
            <source>Drop G-code files here to send them to the gateway</source>
            <translation>پرونده‌های G-code را برای فرستادن به درگاه اینجا رها کنید</translation>
        </message>
        <message>
            <source>Choose a file…</source>
            <translation>انتخاب پرونده…</translation>
        </message>
        <message>
            <source>Start</source>
            <translation>آغاز</translation>
        </message>
        <message>
            <source>Check</source>
            <translation>بررسی</translation>
        </message>
        <message>
            <source>Show</source>
            <translation>نمایش</translation>
        </message>
        <message>
            <source>Delete</source>
            <translation>حذف</translation>
        </message>
        <message>
            <source>Jobs on the gateway</source>
            <translation>کارهای روی درگاه</translation>
        </message>
        <message>
            <source>What the check has found</source>
            <translation>یافته‌های بررسی</translation>
        </message>
        <message>
            <source>Lines of the job</source>
            <translation>خط‌های کار</translation>
        </message>
        <message>
            <source>Choose a finding: its line is shown here, its place in the scene.</source>
            <translation>یک یافته را برگزینید: خطش اینجا و جایش در صحنه نشان داده می‌شود.</translation>
        </message>
        <message>
            <source>Checking %1…</source>
            <translation>در حال بررسی %1…</translation>
        </message>
        <message numerus="yes">
            <source>%1: %Ln error(s). It will not start.</source>
            <translation>
                <numerusform>%1: %Ln خطا. آغاز نخواهد شد.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%1: it can be printed, with %Ln warning(s). It takes %2.</source>
            <translation>
                <numerusform>%1: با %Ln اخطار چاپ‌شدنی است. زمان: %2.</numerusform>
            </translation>
        </message>
        <message>
            <source>%1: nothing is wrong. It takes %2.</source>
            <translation>%1: اشکالی ندارد. زمان: %2.</translation>
        </message>
        <message>
            <source>The gateway checks a whole job against every limit before anything moves.</source>
            <translation>درگاه پیش از هر حرکت، کل کار را با همهٔ محدوده‌ها می‌سنجد.</translation>
        </message>
        <message>
            <source>%1 of %2 used</source>
            <translation>%1 از %2 پر است</translation>
        </message>
        <message>
            <source>Send G-code to the gateway</source>
            <translation>فرستادن G-code به درگاه</translation>
        </message>
        <message>
            <source>G-code (*.gcode *.ngc *.nc *.g *.gco)</source>
            <translation>G-code (*.gcode *.ngc *.nc *.g *.gco)</translation>
        </message>
        <message>
            <source>All files (*)</source>
            <translation>همهٔ پرونده‌ها (*)</translation>
        </message>
        <message>
            <source>Delete %1 from the gateway?</source>
            <translation>%1 از درگاه حذف شود؟</translation>
        </message>
        <message>
            <source>Keep</source>
            <translation>نگه داشتن</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JogPage</name>
        <message>
            <source>Jog</source>
            <translation>حرکت دستی</translation>
        </message>
        <message>
            <source>Keys: arrows move X and Y, Page Up and Page Down move Z, A and D tilt, Q and W turn the table, 1 to 5 choose the step.</source>
            <translation>کلیدها: پیکان‌ها X و Y را، Page Up و Page Down محور Z را حرکت می‌دهند؛ A و D کج می‌کنند، Q و W میز را می‌چرخانند و 1 تا 5 گام را برمی‌گزینند.</translation>
        </message>
        <message>
            <source>Step, mm or °</source>
            <translation>گام، mm یا °</translation>
        </message>
        <message>
            <source>Speed</source>
            <translation>سرعت</translation>
        </message>
        <message>
            <source>mm/s</source>
            <translation>mm/s</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>ماشین</translation>
        </message>
        <message>
            <source>Home</source>
            <translation>خانه‌یابی</translation>
        </message>
        <message>
            <source>Wakes the nodes and brings all carriages to their switches</source>
            <translation>گره‌ها را بیدار می‌کند و همهٔ حامل‌ها را به کلیدهایشان می‌رساند</translation>
        </message>
        <message>
            <source>Bed reference</source>
            <translation>مرجع بستر</translation>
        </message>
        <message>
            <source>Goes to where every job begins</source>
            <translation>به جایی می‌رود که هر کار از آن آغاز می‌شود</translation>
        </message>
        <message>
            <source>Pause</source>
            <translation>مکث</translation>
        </message>
        <message>
            <source>Clear stop</source>
            <translation>رفع توقف</translation>
        </message>
        <message>
            <source>Motors off</source>
            <translation>خاموش کردن موتورها</translation>
        </message>
        <message>
            <source>Positions are lost: the machine must be homed again</source>
            <translation>موقعیت‌ها از دست می‌روند: ماشین باید دوباره خانه‌یابی شود</translation>
        </message>
        <message>
            <source>Work offsets</source>
            <translation>مبدأهای کاری</translation>
        </message>
        <message>
            <source>Coordinate system</source>
            <translation>دستگاه مختصات</translation>
        </message>
        <message>
            <source>Zero here</source>
            <translation>اینجا صفر</translation>
        </message>
        <message>
            <source>The tool's position becomes the zero of this system</source>
            <translation>موقعیت ابزار صفر این دستگاه می‌شود</translation>
        </message>
        <message>
            <source>Set</source>
            <translation>تنظیم</translation>
        </message>
        <message>
            <source>The values above become the zero of this system</source>
            <translation>مقدارهای بالا صفر این دستگاه می‌شوند</translation>
        </message>
        <message>
            <source>Active: %1, zero at %2</source>
            <translation>فعال: %1، صفر در %2</translation>
        </message>
        <message>
            <source>Zeros of the work coordinates</source>
            <translation>صفرهای مختصات کاری</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MachineFileEditor</name>
        <message>
            <source>Read again</source>
            <translation>خواندن دوباره</translation>
        </message>
        <message>
            <source>Undo</source>
            <translation>واگرد</translation>
        </message>
        <message>
            <source>Save on the gateway</source>
            <translation>ذخیره روی درگاه</translation>
        </message>
        <message>
            <source>Machine file</source>
            <translation>پروندهٔ ماشین</translation>
        </message>
        <message>
            <source>What is wrong in the machine file</source>
            <translation>اشکال‌های پروندهٔ ماشین</translation>
        </message>
        <message>
            <source>Saved. The gateway uses it from its next start.</source>
            <translation>ذخیره شد. درگاه از راه‌اندازی بعدی آن را به کار می‌برد.</translation>
        </message>
        <message>
            <source>The built-in machine file</source>
            <translation>پروندهٔ ماشین درون‌ساخت</translation>
        </message>
        <message>
            <source>Not read yet</source>
            <translation>هنوز خوانده نشده</translation>
        </message>
        <message>
            <source>cannot be changed from here</source>
            <translation>از اینجا تغییرپذیر نیست</translation>
        </message>
        <message>
            <source>newer than what the gateway runs with</source>
            <translation>تازه‌تر از آنچه درگاه به کار می‌برد</translation>
        </message>
        <message>
            <source>The machine file says what the machine is: kinematics, axes, limits, nodes.</source>
            <translation>پروندهٔ ماشین می‌گوید ماشین چیست: سینماتیک، محورها، محدوده‌ها، گره‌ها.</translation>
        </message>
        <message>
            <source>Checking…</source>
            <translation>در حال بررسی…</translation>
        </message>
        <message>
            <source>The file is right.</source>
            <translation>پرونده درست است.</translation>
        </message>
        <message numerus="yes">
            <source>%Ln mistake(s): it cannot be saved.</source>
            <translation>
                <numerusform>%Ln اشتباه: ذخیره نمی‌شود.</numerusform>
            </translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MachinePage</name>
        <message>
            <source>Axes and nodes</source>
            <translation>محورها و گره‌ها</translation>
        </message>
        <message>
            <source>Bus and time</source>
            <translation>گذرگاه و زمان</translation>
        </message>
        <message>
            <source>Machine file</source>
            <translation>پروندهٔ ماشین</translation>
        </message>
        <message>
            <source>Axes</source>
            <translation>محورها</translation>
        </message>
        <message>
            <source>Nodes</source>
            <translation>گره‌ها</translation>
        </message>
        <message>
            <source>Bus load</source>
            <translation>بار گذرگاه</translation>
        </message>
        <message>
            <source>%1 µs</source>
            <translation>%1 µs</translation>
        </message>
        <message>
            <source>Largest clock error</source>
            <translation>بیشترین خطای ساعت</translation>
        </message>
        <message>
            <source>Emptiest queue</source>
            <translation>خالی‌ترین صف</translation>
        </message>
        <message>
            <source>Path rate</source>
            <translation>نرخ مسیر</translation>
        </message>
        <message>
            <source>Nozzle temperature</source>
            <translation>دمای نازل</translation>
        </message>
        <message>
            <source>Bed temperature</source>
            <translation>دمای بستر</translation>
        </message>
        <message>
            <source>Frames sent</source>
            <translation>قاب‌های فرستاده</translation>
        </message>
        <message>
            <source>Frames received</source>
            <translation>قاب‌های دریافتی</translation>
        </message>
        <message>
            <source>Segments sent</source>
            <translation>قطعه‌های فرستاده</translation>
        </message>
        <message>
            <source>Sequence errors</source>
            <translation>خطاهای ترتیب</translation>
        </message>
        <message>
            <source>Underruns</source>
            <translation>خالی شدن صف</translation>
        </message>
        <message>
            <source>Unreadable frames</source>
            <translation>قاب‌های ناخوانا</translation>
        </message>
        <message>
            <source>Frames of strangers</source>
            <translation>قاب‌های بیگانه</translation>
        </message>
        <message>
            <source>Slowed for the bus</source>
            <translation>کندشده برای گذرگاه</translation>
        </message>
        <message>
            <source>Held for planning</source>
            <translation>نگه‌داشته برای برنامه‌ریزی</translation>
        </message>
        <message>
            <source>Not connected.</source>
            <translation>وصل نیست.</translation>
        </message>
        <message>
            <source>%1 · kinematics %2 · %3 axes on %4 nodes · bus %5</source>
            <translation>%1 · سینماتیک %2 · %3 محور روی %4 گره · گذرگاه %5</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MainWindow</name>
        <message>
            <source>Gateways</source>
            <translation>درگاه‌ها</translation>
        </message>
        <message>
            <source>View</source>
            <translation>نما</translation>
        </message>
        <message>
            <source>Jobs</source>
            <translation>کارها</translation>
        </message>
        <message>
            <source>Jog</source>
            <translation>حرکت دستی</translation>
        </message>
        <message>
            <source>Console</source>
            <translation>پایانه</translation>
        </message>
        <message>
            <source>Alarms</source>
            <translation>هشدارها</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>ماشین</translation>
        </message>
        <message>
            <source>Position</source>
            <translation>موقعیت</translation>
        </message>
        <message>
            <source>Job</source>
            <translation>کار</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::NodesModel</name>
        <message>
            <source>Node</source>
            <translation>گره</translation>
        </message>
        <message>
            <source>State</source>
            <translation>وضعیت</translation>
        </message>
        <message>
            <source>Clock error</source>
            <translation>خطای ساعت</translation>
        </message>
        <message>
            <source>Queue</source>
            <translation>صف</translation>
        </message>
        <message>
            <source>Inputs</source>
            <translation>ورودی‌ها</translation>
        </message>
        <message>
            <source>Segments sent</source>
            <translation>قطعه‌های فرستاده</translation>
        </message>
        <message>
            <source>Faults</source>
            <translation>خطاها</translation>
        </message>
        <message>
            <source>Not there</source>
            <translation>حاضر نیست</translation>
        </message>
        <message>
            <source>Stopped</source>
            <translation>متوقف</translation>
        </message>
        <message>
            <source>Starting</source>
            <translation>در حال راه‌اندازی</translation>
        </message>
        <message>
            <source>Idle</source>
            <translation>بیکار</translation>
        </message>
        <message>
            <source>Operational</source>
            <translation>آمادهٔ کار</translation>
        </message>
        <message>
            <source>Operational, not in time</source>
            <translation>آمادهٔ کار، ناهم‌زمان</translation>
        </message>
        <message>
            <source>Waiting</source>
            <translation>در انتظار</translation>
        </message>
        <message>
            <source>%1 µs</source>
            <translation>%1 µs</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::PositionPanel</name>
        <message>
            <source>Carriages and axes</source>
            <translation>حامل‌ها و محورها</translation>
        </message>
        <message>
            <source>Heat</source>
            <translation>گرما</translation>
        </message>
        <message>
            <source>Target temperature of the nozzle</source>
            <translation>دمای هدف نازل</translation>
        </message>
        <message>
            <source>Target temperature of the bed</source>
            <translation>دمای هدف بستر</translation>
        </message>
        <message>
            <source>off</source>
            <translation>خاموش</translation>
        </message>
        <message>
            <source>Bed</source>
            <translation>بستر</translation>
        </message>
        <message>
            <source>Nozzle</source>
            <translation>نازل</translation>
        </message>
        <message>
            <source>Fan</source>
            <translation>فن</translation>
        </message>
        <message>
            <source>Tool over the part</source>
            <translation>ابزار نسبت به قطعه</translation>
        </message>
        <message>
            <source>Position not known yet</source>
            <translation>موقعیت هنوز معلوم نیست</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ProblemsModel</name>
        <message>
            <source>Error</source>
            <translation>خطا</translation>
        </message>
        <message>
            <source>Warning</source>
            <translation>اخطار</translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>نوع</translation>
        </message>
        <message>
            <source>Line</source>
            <translation>خط</translation>
        </message>
        <message>
            <source>What is wrong</source>
            <translation>اشکال</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::Session</name>
        <message>
            <source>expected %1</source>
            <translation>مقدار مجاز: %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::SocketLink</name>
        <message>
            <source>the gateway closed the connection</source>
            <translation>درگاه اتصال را بست</translation>
        </message>
        <message>
            <source>on this computer</source>
            <translation>روی این رایانه</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::TopBar</name>
        <message>
            <source>STOP</source>
            <translation>ایست</translation>
        </message>
        <message>
            <source>Stops all motion at once, on the path (Ctrl+.)</source>
            <translation>همهٔ حرکت‌ها را بی‌درنگ روی مسیر می‌ایستاند (Ctrl+.)</translation>
        </message>
        <message>
            <source>Language</source>
            <translation>زبان</translation>
        </message>
        <message>
            <source>Light or dark</source>
            <translation>روشن یا تیره</translation>
        </message>
        <message>
            <source>Take control</source>
            <translation>گرفتن کنترل</translation>
        </message>
        <message>
            <source>%1 has control</source>
            <translation>کنترل در دست %1 است</translation>
        </message>
        <message>
            <source>Not connected</source>
            <translation>وصل نیست</translation>
        </message>
        <message>
            <source>Connecting</source>
            <translation>در حال اتصال</translation>
        </message>
        <message>
            <source>Connection lost</source>
            <translation>اتصال قطع شد</translation>
        </message>
        <message>
            <source>A job on the machine goes on.</source>
            <translation>کار روی ماشین ادامه دارد.</translation>
        </message>
        <message>
            <source>Connect</source>
            <translation>اتصال</translation>
        </message>
        <message>
            <source>%1 · %2</source>
            <translation>%1 · %2</translation>
        </message>
        <message>
            <source>Choose a gateway</source>
            <translation>یک درگاه برگزینید</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::UsbLink</name>
        <message>
            <source>the USB cable was pulled</source>
            <translation>کابل USB کشیده شد</translation>
        </message>
        <message>
            <source>the gateway is not plugged in</source>
            <translation>درگاه وصل نیست</translation>
        </message>
        <message>
            <source>this user may not use the USB device: install the udev rule of the package</source>
            <translation>این کاربر اجازهٔ دستگاه USB را ندارد: قاعدهٔ udev بسته را نصب کنید</translation>
        </message>
        <message>
            <source>another program uses the gateway's USB link</source>
            <translation>برنامهٔ دیگری پیوند USB درگاه را به کار می‌برد</translation>
        </message>
        <message>
            <source>the USB link does not start</source>
            <translation>پیوند USB آغاز نمی‌شود</translation>
        </message>
        <message>
            <source>USB %1</source>
            <translation>USB %1</translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ViewPage</name>
        <message>
            <source>The 3D scene cannot be shown: %1</source>
            <translation>صحنهٔ سه‌بعدی نشان‌دادنی نیست: %1</translation>
        </message>
        <message>
            <source>Scene: machine and tool path</source>
            <translation>صحنه: ماشین و مسیر ابزار</translation>
        </message>
        <message>
            <source>Show the layers up to here</source>
            <translation>نمایش لایه‌ها تا اینجا</translation>
        </message>
        <message>
            <source>Colour by</source>
            <translation>رنگ بر پایهٔ</translation>
        </message>
        <message>
            <source>Feed</source>
            <translation>سرعت پیشروی</translation>
        </message>
        <message>
            <source>Layer</source>
            <translation>لایه</translation>
        </message>
        <message>
            <source>Limit margin</source>
            <translation>فاصله تا محدوده</translation>
        </message>
        <message>
            <source>Colour of the tool path</source>
            <translation>رنگ مسیر ابزار</translation>
        </message>
        <message>
            <source>Machine</source>
            <translation>ماشین</translation>
        </message>
        <message>
            <source>Reach of the tool</source>
            <translation>دسترس ابزار</translation>
        </message>
        <message>
            <source>Moves without extrusion</source>
            <translation>حرکت‌های بدون اکستروژن</translation>
        </message>
        <message>
            <source>What is not printed yet</source>
            <translation>آنچه هنوز چاپ نشده</translation>
        </message>
        <message>
            <source>From a corner</source>
            <translation>از گوشه</translation>
        </message>
        <message>
            <source>From above</source>
            <translation>از بالا</translation>
        </message>
        <message>
            <source>From the front</source>
            <translation>از روبه‌رو</translation>
        </message>
        <message>
            <source>Whole machine (M)</source>
            <translation>کل ماشین (M)</translation>
        </message>
        <message>
            <source>The part alone (F)</source>
            <translation>تنها قطعه (F)</translation>
        </message>
        <message>
            <source>%1 mm/s</source>
            <translation>%1 mm/s</translation>
        </message>
        <message>
            <source>at a limit</source>
            <translation>در مرز</translation>
        </message>
        <message>
            <source>free</source>
            <translation>آزاد</translation>
        </message>
        <message>
            <source>%1 cannot be shown: %2</source>
            <translation>%1 نشان‌دادنی نیست: %2</translation>
        </message>
        <message>
            <source>Reading %1</source>
            <translation>خواندن %1</translation>
        </message>
        <message>
            <source>%1 · %2 lines · %3 layers · %4 m of path</source>
            <translation>%1 · %2 خط · %3 لایه · %4 متر مسیر</translation>
        </message>
        <message numerus="yes">
            <source>%Ln line(s) with expressions are not drawn</source>
            <translation>
                <numerusform>%Ln خط دارای عبارت رسم نشد</numerusform>
            </translation>
        </message>
        <message>
            <source>No job is shown. Choose one on the Jobs page.</source>
            <translation>کاری نشان داده نمی‌شود. از صفحهٔ «کارها» یکی را برگزینید.</translation>
        </message>
        <message>
            <source>%1 mm</source>
            <translation>%1 mm</translation>
        </message>
    </context>
<context>
    <name>GatewayWords</name>
    <message>
        <source>move done</source>
        <translation>حرکت انجام شد</translation>
    </message>
    <message>
        <source>job done: %1</source>
        <translation>کار تمام شد: %1</translation>
    </message>
    <message>
        <source>all lines done: %1</source>
        <translation>همهٔ خط‌ها انجام شد: %1</translation>
    </message>
    <message>
        <source>the job was not begun: it has %1 errors</source>
        <translation>کار آغاز نشد: %1 خطا دارد</translation>
    </message>
    <message>
        <source>stop by command</source>
        <translation>ایست به فرمان</translation>
    </message>
    <message>
        <source>homed</source>
        <translation>خانه‌یابی شد</translation>
    </message>
    <message>
        <source>%1 has control</source>
        <translation>کنترل در دست %1 است</translation>
    </message>
    <message>
        <source>nobody has control</source>
        <translation>کنترل در دست کسی نیست</translation>
    </message>
    <message>
        <source>the job %1 was interrupted: resume to go on with it, or cancel</source>
        <translation>کار %1 نیمه‌کاره ماند: ادامه دهید یا لغو کنید</translation>
    </message>
    <message>
        <source>the job %1 goes on</source>
        <translation>کار %1 ادامه یافت</translation>
    </message>
    <message>
        <source>cancelled: positions are known</source>
        <translation>لغو شد: موقعیت‌ها معلوم‌اند</translation>
    </message>
    <message>
        <source>cleared: bring the machine up again</source>
        <translation>رفع شد: ماشین را دوباره بیدار کنید</translation>
    </message>
    <message>
        <source>cleared: resume brings the machine up again and goes on with the job</source>
        <translation>رفع شد: ادامه، ماشین را بیدار می‌کند و کار را پی می‌گیرد</translation>
    </message>
    <message>
        <source>%1 is %2 outside the workspace</source>
        <translation>%1 به اندازهٔ %2 بیرون از فضای کاری است</translation>
    </message>
    <message>
        <source>%1: out of reach, the leg is %2 too short</source>
        <translation>%1: دور از دسترس، پایه %2 کوتاه است</translation>
    </message>
    <message>
        <source>%1: would be %2 beyond its travel</source>
        <translation>%1: %2 فراتر از بازهٔ حرکتش می‌رود</translation>
    </message>
    <message>
        <source>%1: the leg leans %2 too far from its rail</source>
        <translation>%1: پایه %2 بیش از اندازه از ریل کج می‌شود</translation>
    </message>
    <message>
        <source>%1: leg, rail and platform come %2 too near to each other</source>
        <translation>%1: پایه، ریل و سکو %2 بیش از اندازه به هم نزدیک می‌شوند</translation>
    </message>
    <message>
        <source>too near to a singular pose: condition number %1</source>
        <translation>بیش از اندازه نزدیک به حالت تکین: عدد شرطی %1</translation>
    </message>
    <message>
        <source>filament is fed before the job has set a hotend temperature (M104)</source>
        <translation>پیش از تعیین دمای نازل (M104) فیلامنت رانده می‌شود</translation>
    </message>
    <message>
        <source>filament is fed with the hotend at %1 °C; at least %2 °C is needed</source>
        <translation>فیلامنت با نازل %1 °C رانده می‌شود؛ دست‌کم %2 °C لازم است</translation>
    </message>
    <message>
        <source>M112 stops the machine here</source>
        <translation>M112 ماشین را اینجا می‌ایستاند</translation>
    </message>
    <message>
        <source>settings are kept in the machine file: M500 to M503 do nothing in a job</source>
        <translation>تنظیم‌ها در پروندهٔ ماشین هستند: M500 تا M503 در کار بی‌اثرند</translation>
    </message>
    <message>
        <source>this machine has no heater for the hotend</source>
        <translation>این ماشین گرم‌کن نازل ندارد</translation>
    </message>
    <message>
        <source>this machine has no heater for the bed</source>
        <translation>این ماشین گرم‌کن بستر ندارد</translation>
    </message>
    <message>
        <source>hotend temperature %1 °C; allowed are 0 to %2 °C</source>
        <translation>دمای نازل %1 °C؛ مجاز 0 تا %2 °C</translation>
    </message>
    <message>
        <source>bed temperature %1 °C; allowed are 0 to %2 °C</source>
        <translation>دمای بستر %1 °C؛ مجاز 0 تا %2 °C</translation>
    </message>
    <message>
        <source>a job cannot manage stored jobs: M20 to M32 belong to a session</source>
        <translation>کار نمی‌تواند کارهای ذخیره‌شده را مدیریت کند: M20 تا M32 از آنِ نشست است</translation>
    </message>
</context>
</TS>
