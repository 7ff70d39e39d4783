<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
    <context>
        <name>kinebus::gui::JobsModel</name>
        <message numerus="yes">
            <source>%n error(s)</source>
            <translation>
                <numerusform>%n error</numerusform>
                <numerusform>%n errors</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%n warning(s)</source>
            <translation>
                <numerusform>%n warning</numerusform>
                <numerusform>%n warnings</numerusform>
            </translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::JobsPage</name>
        <message numerus="yes">
            <source>%1: %n error(s). It will not start.</source>
            <translation>
                <numerusform>%1: %n error. It will not start.</numerusform>
                <numerusform>%1: %n errors. It will not start.</numerusform>
            </translation>
        </message>
        <message numerus="yes">
            <source>%1: it can be printed, with %n warning(s). It takes %2.</source>
            <translation>
                <numerusform>%1: it can be printed, with %n warning. It takes %2.</numerusform>
                <numerusform>%1: it can be printed, with %n warnings. It takes %2.</numerusform>
            </translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::MachineFileEditor</name>
        <message numerus="yes">
            <source>%n mistake(s): it cannot be saved.</source>
            <translation>
                <numerusform>%n mistake: it cannot be saved.</numerusform>
                <numerusform>%n mistakes: it cannot be saved.</numerusform>
            </translation>
        </message>
    </context>
    <context>
        <name>kinebus::gui::ViewPage</name>
        <message numerus="yes">
            <source>%n line(s) with expressions are not drawn</source>
            <translation>
                <numerusform>%n line with expressions is not drawn</numerusform>
                <numerusform>%n lines with expressions are not drawn</numerusform>
            </translation>
        </message>
    </context>
</TS>
