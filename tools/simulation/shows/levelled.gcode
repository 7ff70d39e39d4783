; A square ring on a bed that its macro has measured before
; machine: m1, with levelled.toml
START_LEVELLED HEIGHT=5
M83
G1 X-15 Y-15 Z0.3 F3000
G1 X15 E1 F1800
G1 Y15 E1
G1 X-15 E1
G1 Y-15 E1
G1 Z10 F1800
