# The holding currents as a record of Hyde: awk -f holding.awk stopped_data.txt
# The target was not written down, but how far from it the rotor stood. Two rows of one instant are one.
BEGIN { FS = ", *"; OFS = ","; OFMT = "%.9g"; print "t [s],Target [rad],Position [rad],Iq [A]" }
NR == 2 { start = $1; last = -1 }
NR > 1 && $1 > last { print $1 - start, $2 + $7, $2, $4; last = $1 }
