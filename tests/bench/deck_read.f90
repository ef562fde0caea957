! Reads the nodes and elements of the benchmark's deck with the same FORMATs and prints the processor time.
program deck_read
  use, intrinsic :: iso_fortran_env, only: real64
  implicit none
  character(len=4096) :: path
  character(len=80) :: title
  character(len=3) :: word
  integer :: nodes, i, run, number, step, system, counts(7), element(14)
  real(real64) :: x, y, ratio, total, best, start, finish
  call get_command_argument(1, path)
  best = huge(best)
  do run = 1, 10
    call cpu_time(start)
    open (10, file=trim(path), status='old', action='read')
    read (10, '(A80)') title
    read (10, '(A80)') title
    read (10, '(7I5)') counts
    nodes = counts(3)
    total = 0
    do i = 1, nodes
      read (10, '(3I5,3F10.0)') number, step, system, x, y, ratio
      total = total + x + y
    end do
    do i = 1, counts(7)
      read (10, '(14I5)') element
      total = total + element(3)
    end do
    read (10, '(A3)') word
    close (10)
    call cpu_time(finish)
    best = min(best, finish - start)
  end do
  print '(A,I0,A,F8.1,A,ES13.6,A)', 'Fortran: ', nodes, ' nodes and elements,', 1000*best, ' ms (sum ', total, ')'
end program deck_read
