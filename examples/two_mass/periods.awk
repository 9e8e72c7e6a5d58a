# Periods of 1 s as a record of Hyde, the time from 0: awk -v first=1 -v last=10 -f periods.awk multisine_A.csv
BEGIN { FS = OFS = "," }
NR == 1 { print; next }
NR - 2 >= 2500*first && NR - 2 < 2500*(last + 1) { $1 = (NR - 2 - 2500*first)/2500; print }
