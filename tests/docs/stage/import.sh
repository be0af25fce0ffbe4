# Files of the authors' program: two parts with %% between them.
cuboids=tests/fuzz/corpus/import/cuboids
sed '/^%%$/,$d' $cuboids >box.data
sed '1,/^%%$/d' $cuboids >box.boid
sed '1,/^%%$/d' tests/fuzz/corpus/import/flat >box.grid
