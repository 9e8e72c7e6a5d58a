# A speed test from one time to another as a record of Hyde: awk -v from=S -v to=S -f turning.awk speed_test1.txt
# A row that repeats the one before it was lost on its way. Rows are up to some ms late: they are read linearly every ms. Whole
# turns before the first row are left out, or the place would tell which record it is.
BEGIN { FS = ", *"; OFS = ","; OFMT = "%.9g"; print "t [s],Position [rad],Velocity [rad/s],Iq [A]" }
NR > 1 && $1 >= from && $1 <= to && !($2 == phi && $3 == w && $5 == i) {
  if (t == "") turns = 6.283185307179586*int($2/6.283185307179586)
  for (; t != "" && from + n/1000 <= $1; n++) {
    part = (from + n/1000 - t)/($1 - t)
    print n/1000, phi + part*($2 - phi) - turns, w + part*($3 - w), i + part*($5 - i)
  }
  t = $1; phi = $2; w = $3; i = $5
}
