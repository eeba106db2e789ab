# Error over time, one line per method. Set before loading: $data (one index per method with median time,
# median error, least and most time, least and most error), titles, styles, heading, y_label, output_file.
if (!exists("terminal")) terminal = "svg size 640,500 font 'DejaVu Sans,15' background rgb 'white'"
set terminal @terminal
set output output_file

# Colours of Okabe and Ito, told apart with any kind of colour vision; markers differ as well.
set style line 1 lc rgb "#000000" pt 5 ps 0.8 lw 1.8
set style line 2 lc rgb "#D55E00" pt 9 ps 1.0 lw 1.8
set style line 3 lc rgb "#009E73" pt 13 ps 1.1 lw 1.8
set style line 4 lc rgb "#0072B2" pt 7 ps 0.8 lw 1.8
set style line 5 lc rgb "#CC79A7" pt 11 ps 1.0 lw 1.8
set style line 6 lc rgb "#E69F00" pt 15 ps 1.0 lw 1.8
set style line 7 lc rgb "#56B4E9" pt 6 ps 0.8 lw 1.8
set style line 9 lc rgb "#999999" dt 2 lw 1.2

count = words(titles)
# A guide of slope -1/2 through the first point of the last method.
stats $data index count-1 using (log($1)) nooutput name "X"
stats $data index count-1 using (log($2)) nooutput name "Y"
stats $data using (log($3)) nooutput name "L"
stats $data using (log($4)) nooutput name "M"
stats $data using (log($5)) nooutput name "A"
stats $data using (log($6)) nooutput name "B"
guide(x) = exp(Y_max) * sqrt(exp(X_min) / x)

set logscale xy
set xlabel "wall time [s]" offset 0,0.8
set ylabel y_label
set title heading noenhanced
set xtics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200)
set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
set grid xtics ytics lc rgb "#dddddd" lt 1 lw 0.6
set border 3
set tics nomirror
set key below center horizontal noenhanced samplen 2.5
set xrange [exp(L_min)*0.8:exp(M_max)*1.25]
set yrange [exp(A_min)*0.75:exp(B_max)*1.35]

plot guide(x) with lines ls 9 title "slope −1/2", \
     for [i=1:count] $data index i-1 using 1:2:5:6 with yerrorlines ls int(word(styles, i)) title word(titles, i)
