# Time per sample over the number of luminaires. Set before loading: $data (one index per line, columns as
# for plot.gp), titles, styles, output_file.
if (!exists("terminal")) terminal = "svg size 640,500 font 'DejaVu Sans,15' background rgb 'white'"
set terminal @terminal
set output output_file

# Colours of Okabe and Ito; spheres with full markers, triangles with empty ones and dashes.
set style line 1 lc rgb "#000000" pt 5 ps 0.8 lw 1.8
set style line 2 lc rgb "#D55E00" pt 9 ps 1.0 lw 1.8
set style line 3 lc rgb "#0072B2" pt 7 ps 0.8 lw 1.8
set style line 4 lc rgb "#000000" pt 4 ps 0.8 lw 1.8 dt 3
set style line 5 lc rgb "#D55E00" pt 8 ps 1.0 lw 1.8 dt 3
set style line 6 lc rgb "#0072B2" pt 6 ps 0.8 lw 1.8 dt 3

count = words(titles)
set xlabel "luminaires" offset 0,0.5
set ylabel "time per sample [ns]"
set format x "10^{%L}"
set format y "10^{%L}"
set grid xtics ytics lc rgb "#dddddd" lt 1 lw 0.6
set border 3
set tics nomirror
set key below center horizontal noenhanced samplen 2.5
stats $data using 1 nooutput name "X"
stats $data using 2 nooutput name "Y"
set xrange [X_min*0.8:X_max*1.25]
set yrange [Y_min*0.7:Y_max*1.4]

set logscale xy
plot for [i=1:count] $data index i-1 using 1:2 with linespoints ls int(word(styles, i)) title word(titles, i)
