! Reads cases "#format blanks count kinds" followed by records, and prints what this Fortran runtime makes of each.
! One case: a line "#CASE <blanks> <kinds>" , a line with the FORMAT (or *), then records and spare blank records.
! One output line a case: status, then for each value its kind and bits (hexadecimal) or characters.
program oracle
  use, intrinsic :: iso_fortran_env, only: int32, int64, real64
  implicit none
  integer, parameter :: most = 16, cases = 10, answers = 11
  character(len=4096) :: line, form
  character(len=80) :: text(most)
  integer(int32) :: whole(most)
  real(real64) :: number(most)
  logical :: flag(most)
  integer :: i, status, count, ni(most), nd(most), na(most), nl(most)
  character(len=most) :: kinds
  character(len=4) :: blanks
  character(len=4096) :: in_file, out_file

  call get_command_argument(1, in_file)
  call get_command_argument(2, out_file)
  open (cases, file=trim(in_file), status='old', action='read')
  open (answers, file=trim(out_file), status='replace', action='write')
  do
    read (cases, '(A)', iostat=status) line
    if (status /= 0) exit
    if (line(1:6) /= '#CASE ') cycle
    blanks = line(7:10)
    kinds = line(12:)
    read (cases, '(A)') form
    count = len_trim(kinds)
    ni = 0; nd = 0; na = 0; nl = 0
    do i = 1, count
      select case (kinds(i:i))
      case ('I'); ni(i) = 1
      case ('D'); nd(i) = 1
      case ('A'); na(i) = 1
      case ('L'); nl(i) = 1
      end select
    end do
    whole = -77777; number = -77777.5_real64; text = '~'; flag = .false.
    if (form(1:1) == '*') then
      if (blanks == 'ZERO') cycle
      read (cases, *, iostat=status) (whole(i:i-1+ni(i)), number(i:i-1+nd(i)), text(i:i-1+na(i)), &
                                      flag(i:i-1+nl(i)), i=1, count)
    else
      read (cases, trim(form), blank=blanks, iostat=status) &
        (whole(i:i-1+ni(i)), number(i:i-1+nd(i)), text(i:i-1+na(i)), flag(i:i-1+nl(i)), i=1, count)
    end if
    write (answers, '(I0)', advance='no') status
    do i = 1, count
      select case (kinds(i:i))
      case ('I'); write (answers, '(A,I0)', advance='no') ' I', whole(i)
      case ('D'); write (answers, '(A,Z16.16)', advance='no') ' D', transfer(number(i), 0_int64)
      case ('A'); write (answers, '(3A)', advance='no') ' A<', trim(text(i)), '>'
      case ('L'); write (answers, '(A,L1)', advance='no') ' L', flag(i)
      end select
    end do
    read (cases, '(A)', iostat=status) line   ! what the next READ would see
    write (answers, '(3A)') ' N<', trim(line), '>'
  end do
end program oracle
