<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
<context>
    <name>kinebus::gui::JobsModel</name>
    <message numerus="yes">
        <source>%Ln error(s)</source>
        <translation>
            <numerusform>%Ln error</numerusform>
            <numerusform>%Ln errors</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%Ln warning(s)</source>
        <translation>
            <numerusform>%Ln warning</numerusform>
            <numerusform>%Ln warnings</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>kinebus::gui::JobsPage</name>
    <message numerus="yes">
        <source>%1: %Ln error(s). It will not start.</source>
        <translation>
            <numerusform>%1: %Ln error. It will not start.</numerusform>
            <numerusform>%1: %Ln errors. It will not start.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%1: it can be printed, with %Ln warning(s). It takes %2.</source>
        <translation>
            <numerusform>%1: it can be printed, with %Ln warning. It takes %2.</numerusform>
            <numerusform>%1: it can be printed, with %Ln warnings. It takes %2.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>kinebus::gui::MachineFileEditor</name>
    <message numerus="yes">
        <source>%Ln mistake(s): it cannot be saved.</source>
        <translation>
            <numerusform>%Ln mistake: it cannot be saved.</numerusform>
            <numerusform>%Ln mistakes: it cannot be saved.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>kinebus::gui::ViewPage</name>
    <message numerus="yes">
        <source>%Ln line(s) are refused and not drawn</source>
        <translation>
            <numerusform>%Ln line is refused and not drawn</numerusform>
            <numerusform>%Ln lines are refused and not drawn</numerusform>
        </translation>
    </message>
</context>
</TS>
