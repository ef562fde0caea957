C     Elasticity with the fault that PROPS(3) names, from the increment
C     PROPS(4) on: PROPS are E, nu, fault, increment.
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,RPL,DDSDDT,
     1 DRPLDE,DRPLDT,STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,
     2 CMNAME,NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     3 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(*),STATEV(*),DDSDDE(NTENS,NTENS),
     1 DDSDDT(NTENS),DRPLDE(NTENS),STRAN(NTENS),DSTRAN(NTENS),TIME(*),
     2 PREDEF(1),DPRED(1),PROPS(NPROPS),COORDS(3),DROT(3,3),
     3 DFGRD0(3,3),DFGRD1(3,3)
      DIMENSION STR(6),INTV(1),REALV(1)
      CHARACTER*8 CHARV(1)
      SAVE KOUNT
      DATA KOUNT/0/
      EG=PROPS(1)/(2.D0*(1.D0+PROPS(2)))
      ELAM=2.D0*EG*PROPS(2)/(1.D0-2.D0*PROPS(2))
      KIND=0
      IF (KINC.GE.INT(PROPS(4))) KIND=INT(PROPS(3))
      DO K1=1,NTENS
        STR(K1)=DSTRAN(K1)
      END DO
      IF (KIND.EQ.10) THEN
        DO K1=1,3
          STR(K1)=DFGRD1(K1,K1)-DFGRD0(K1,K1)
        END DO
        STR(4)=DFGRD1(1,2)+DFGRD1(2,1)
      END IF
      DO K1=1,NDI
        DO K2=1,NDI
          DDSDDE(K2,K1)=ELAM
        END DO
        DDSDDE(K1,K1)=ELAM+2.D0*EG
      END DO
      DO K1=NDI+1,NTENS
        DDSDDE(K1,K1)=EG
        IF (KIND.EQ.16) DDSDDE(K1,K1)=2.D0*EG
      END DO
      DO K1=1,NTENS
        DO K2=1,NTENS
          D=DDSDDE(K2,K1)
          IF (KIND.EQ.16.AND.K1.GT.NDI.AND.K1.EQ.K2) D=EG
          STRESS(K2)=STRESS(K2)+D*STR(K1)
        END DO
      END DO
      IF (KIND.EQ.1) CALL ZERO36(DDSDDE)
      IF (KIND.EQ.2) STRESS(5)=0.D0
      IF (KIND.EQ.3) STATEV(NSTATV+1)=1.D0
      IF (KIND.EQ.4) CALL XIT
      IF (KIND.EQ.5) STOP 'no convergence'
      IF (KIND.EQ.6.AND.DTIME.GT.0.06D0) PNEWDT=0.5D0
      IF (KIND.EQ.7) THEN
        KOUNT=KOUNT+1
        WRITE(6,*) 'called', KOUNT, NOEL, NPT, STRESS(1)
        PRINT *, 'again and again and again and again and again'
      END IF
      IF (KIND.EQ.8) STRESS(1)=SQRT(-1.D0-ABS(STRESS(1)))
      IF (KIND.EQ.9) PROPS(1)=1.D0
      IF (KIND.EQ.11) STOP 12
      IF (KIND.EQ.13) THEN
        INTV(1)=NOEL
        REALV(1)=2.5D0
        CHARV(1)='clay'
        CALL STDB_ABQERR(-3,'element %I of %S has %R',INTV,REALV,CHARV)
      END IF
      IF (KIND.EQ.14) CALL EXIT(3)
      IF (KIND.EQ.15) STATEV(1)=STATEV(1)+1.D0
      IF (KIND.EQ.17) DDSDDE(1,2)=-DDSDDE(1,2)
      IF (KIND.EQ.18) DDSDDE(1,2)=1.5D0*DDSDDE(1,2)
      IF (KIND.EQ.19) CALL NOWHERE(STRESS)
      IF (KIND.EQ.20) OPEN(77,FILE='no/such/file',STATUS='OLD')
      IF (KIND.EQ.21) CALL DEEP(1,D)
      IF (KIND.EQ.22) TIME(3)=0.D0
      IF (KIND.EQ.23) STATEV(5000)=0.D0
      IF (KIND.EQ.24) CALL TITLE(CMNAME)
      IF (KIND.EQ.26) CALL NOWEXT(0)
      IF (KIND.EQ.27) DDSDDE(1,1)=1.001D0*DDSDDE(1,1)
      IF (KIND.EQ.28) SPD=SQRT(-1.D0-ABS(STRESS(1)))
      RETURN
      END
C     Writes behind a text.
      SUBROUTINE TITLE(TEXT)
      CHARACTER*(*) TEXT
      I=83
      TEXT(I:I)='X'
      END
C     Ends the process without a word.
      SUBROUTINE NOWEXT(K)
      USE ISO_C_BINDING
      INTERFACE
        SUBROUTINE CEXIT(CODE) BIND(C,NAME='_exit')
          IMPORT :: C_INT
          INTEGER(C_INT), VALUE :: CODE
        END SUBROUTINE
      END INTERFACE
      CALL CEXIT(INT(K,C_INT))
      END
C     Writes far beyond all memory.
      SUBROUTINE NOWHERE(A)
      DOUBLE PRECISION A(*)
      INTEGER*8 I
      DO I=1,8
        A(I*2_8**44)=0.D0
      END DO
      END
C     Uses up the stack.
      RECURSIVE SUBROUTINE DEEP(N,D)
      DOUBLE PRECISION A(10000),D
      DO I=1,10000
        A(I)=N+I+D
      END DO
      IF (N.GT.0) CALL DEEP(N+1,A(MOD(N,9999)+1))
      D=D+A(17)
      END
C     As a routine for three dimensions has it.
      SUBROUTINE ZERO36(D)
      DOUBLE PRECISION D(6,6)
      DO J=1,6
        DO I=1,6
          IF (I.GT.4.OR.J.GT.4) D(I,J)=0.D0
        END DO
      END DO
      END
