# Files of the authors' program: two parts with %% between them.
cuboids=tests/python/mph_files/cuboids
sed '/^%%$/,$d' $cuboids >box.data
sed '1,/^%%$/d' $cuboids >box.boid
sed '1,/^%%$/d' tests/python/mph_files/flat >box.grid
